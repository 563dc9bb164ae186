// Cameras that hang, and cameras that answer but send nothing.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "common/core/clock.h"
#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using CaptureSilentTest = CaptureTest;

TEST_F(CaptureSilentTest, AFreezeOfTwoSecondsEndsInPairsAgainAndNoneIsWrong) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(30, 10)) << harness.process().Err();
  const std::size_t before = harness.events().size();
  harness.left().Freeze();
  harness.Receive(2);
  harness.left().Thaw();
  const double thawed_s = MonotonicSeconds();
  ASSERT_TRUE(harness.ReceivePairs(1, 8));
  // A camera that hung still obeys the connection that was given up until that says farewell.
  const double resumed_s = MonotonicSeconds() - thawed_s;
  std::printf("pairs %.2f s after it thawed\n", resumed_s);
  EXPECT_LT(resumed_s, 4);
  ASSERT_TRUE(harness.ReceivePairs(30, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
  EXPECT_LT(LongestRightGap(harness, before), 0.3 + 0.2);
}

TEST_F(CaptureSilentTest, ACameraThatFallsSilentButAnswersIsConnectedAnew) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(30, 10)) << harness.process().Err();
  harness.left().Mute();
  harness.Receive(1.5);
  harness.left().Unmute();
  const double unmuted_s = MonotonicSeconds();
  ASSERT_TRUE(harness.ReceivePairs(1, 5));
  const double resumed_s = MonotonicSeconds() - unmuted_s;
  std::printf("pairs %.2f s after it unmuted\n", resumed_s);
  EXPECT_LT(resumed_s, 1.0 + 0.2);
  ASSERT_TRUE(harness.ReceivePairs(30, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
}

}  // namespace
}  // namespace visavis
