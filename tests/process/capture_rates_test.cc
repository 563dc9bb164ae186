// Pairs at full size and rate, for some seconds.
#include <gtest/gtest.h>

#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using CaptureRatesTest = CaptureTest;

/// Pairs of some seconds at a rate: none wrong, at most one missing (0.1 % of so few is none, but
/// the machine of a test may have no time for 40 ms; scripts/figures-capture runs a minute).
void ExpectPairs(CaptureHarness* harness, double rate_hz, double seconds) {
  ASSERT_TRUE(harness->ReceivePairs(1, 10)) << harness->process().Err();
  harness->Receive(1);
  const std::int64_t from_tick = harness->events().back().right_tick.value_or(0);
  harness->Receive(seconds);
  EXPECT_EQ(harness->num_wrong(), 0);
  EXPECT_GE(harness->num_exposed(from_tick), rate_hz * seconds / 2);
  EXPECT_LE(harness->NumMissing(from_tick), 1) << "of " << harness->num_exposed(from_tick);
}

TEST_F(CaptureRatesTest, AllOf30PairsASecondAtFullSize) {
  options_.left.width = options_.right.width = 640;
  options_.left.height = options_.right.height = 480;
  CaptureHarness harness(options_);
  ExpectPairs(&harness, 30, 2);
}

TEST_F(CaptureRatesTest, AllOf60PairsASecondAtFullSize) {
  options_.left.width = options_.right.width = 640;
  options_.left.height = options_.right.height = 480;
  options_.frame_rate_hz = 60;
  CaptureHarness harness(options_);
  ExpectPairs(&harness, 60, 2);
}

}  // namespace
}  // namespace visavis
