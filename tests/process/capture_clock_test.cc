// Cameras whose clocks differ, drift and jump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using CaptureClockTest = CaptureTest;

TEST_F(CaptureClockTest, ClocksApartAndDriftingGivePairsOfWhichNoneIsWrong) {
  options_.left.clock_start_s = 0.010;
  options_.left.drift_ppm = 50;
  options_.right.drift_ppm = -50;
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(1, 10)) << harness.process().Err();
  harness.Receive(1);
  const std::int64_t from_tick = harness.events().back().right_tick.value_or(0);
  harness.Receive(4);
  EXPECT_EQ(harness.num_wrong(), 0);
  EXPECT_LE(harness.NumMissing(from_tick), 1) << harness.num_exposed(from_tick);
  EXPECT_GE(harness.num_exposed(from_tick), 4 * 30 - 30);
}

TEST_F(CaptureClockTest, AClockThatIsSetWhileRunningCostsSomePairsAndNoneIsWrong) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(30, 10)) << harness.process().Err();
  harness.left().StepClock(37);
  harness.Receive(0.3);
  ASSERT_TRUE(harness.ReceivePairs(30, 3));
  harness.left().StepClock(-40);
  harness.Receive(0.3);
  ASSERT_TRUE(harness.ReceivePairs(30, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
}

}  // namespace
}  // namespace visavis
