// Two hundred reconnects leak nothing: memory, descriptors and threads, printed on the way.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using CaptureLeakTest = CaptureTest;

TEST_F(CaptureLeakTest, TwoHundredReconnectsLeakNothing) {
  const char* wanted = std::getenv("VISAVIS_RECONNECTS");
  const int reconnects = wanted ? std::atoi(wanted) : 200;
  options_.frame_rate_hz = 100;
  options_.settings = {"camera.stall_ms=60"};
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(10, 10)) << harness.process().Err();
  ProcessUse settled;
  for (int i = 1; i <= reconnects; ++i) {
    harness.left().Mute();  // answers, so that nothing waits for it, but must be connected anew
    ASSERT_TRUE(harness.Receive(5, [&, before = harness.events().size()] {
      return CountSingles(harness, before) > 2;
    })) << i;
    harness.left().Unmute();
    ASSERT_TRUE(harness.ReceivePairs(2, 5)) << i;
    // What is kept for good is had after some: arenas, tables.
    if (i == reconnects / 4) settled = UseOf(harness.process().pid());
    if (i % 50 != 0 && i != reconnects) continue;
    const ProcessUse use = UseOf(harness.process().pid());
    std::printf("%3d reconnects: %.1f MB, %d descriptors, %d threads\n", i, use.resident_mb,
                use.num_descriptors, use.num_threads);
  }
  // A teardown may be in work: its thread, and the stream's and heartbeat's of the old connection.
  harness.Receive(1);
  const ProcessUse last = UseOf(harness.process().pid());
  EXPECT_LE(last.num_descriptors, settled.num_descriptors + 6);
  EXPECT_LE(last.num_threads, settled.num_threads + 3);
  // Less than one leaked stream: 12 buffers of 230 kB.
  EXPECT_LT(last.resident_mb, settled.resident_mb + 2.5);
  EXPECT_EQ(harness.num_wrong(), 0);
  EXPECT_TRUE(harness.Receive(2.5, [&] { return harness.Counter("left_connects") > reconnects; }));
}

}  // namespace
}  // namespace visavis
