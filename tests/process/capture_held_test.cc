// Cameras that obey somebody else, lose frames, or lie about them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "common/core/clock.h"
#include "common/gige/gobject.h"
#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using CaptureHeldTest = CaptureTest;

TEST_F(CaptureHeldTest, ACameraThatACrashedClientHoldsIsHadWithinFourSeconds) {
  CaptureHarness::Options first = options_;
  CaptureHarness harness(first);
  ASSERT_TRUE(harness.ReceivePairs(10, 10)) << harness.process().Err();
  harness.process().Signal(SIGKILL);  // a client that crashed: both cameras are held
  ASSERT_TRUE(harness.process().Wait(std::chrono::seconds(2)));
  harness.Receive(0.1);
  harness.Restart();
  const double restarted_s = MonotonicSeconds();
  ASSERT_TRUE(harness.ReceivePairs(1, 10)) << harness.process().Err();
  const double resumed_s = MonotonicSeconds() - restarted_s;
  std::printf("pairs %.2f s after it restarted\n", resumed_s);
  EXPECT_LT(resumed_s, 4);
  ASSERT_TRUE(harness.ReceivePairs(10, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
}

TEST_F(CaptureHeldTest, LostFramesAreCountedAndTheirPartnersAreNoPair) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(30, 10)) << harness.process().Err();
  for (int i = 0; i < 5; ++i) {
    harness.left().Drop(1);
    ASSERT_TRUE(harness.ReceivePairs(10, 3));
  }
  EXPECT_EQ(harness.num_wrong(), 0);
  EXPECT_TRUE(harness.Receive(2.5, [&] { return harness.Counter("left_lost_frames") >= 5; }));
  EXPECT_GE(harness.Counter("right_unpaired_frames"), 5);
}

TEST_F(CaptureHeldTest, FramesThatLieAboutThemselvesAreNeverPublished) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(10, 10)) << harness.process().Err();
  // The camera changes its mind behind our back: the frames' headers and sizes are others now.
  for (const auto& [address, value] : std::vector<std::pair<std::uint32_t, std::uint32_t>>{
           {ARV_FAKE_CAMERA_REGISTER_HEIGHT, 120},
           {ARV_FAKE_CAMERA_REGISTER_WIDTH, 160},
           {ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, ARV_PIXEL_FORMAT_MONO_8}}) {
    const auto before = harness.left().ReadRegister(address);
    harness.left().WriteRegister(address, value);
    harness.Receive(0.1);  // what was on its way
    const std::size_t first = harness.events().size();
    harness.Receive(0.4);
    for (std::size_t i = first; i < harness.events().size(); ++i)
      EXPECT_FALSE(harness.events()[i].left_tick) << address;
    harness.left().WriteRegister(address, before);
    ASSERT_TRUE(harness.ReceivePairs(3, 5)) << address;
  }
  EXPECT_EQ(harness.num_wrong(), 0);
}

}  // namespace
}  // namespace visavis
