// Cameras that lose their power, and come back.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "common/core/clock.h"
#include "tests/support/capture_test.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

using CaptureAwayTest = CaptureTest;

TEST_F(CaptureAwayTest, ADeadCameraIsToldTheOtherGoesOnAndPairsResumeSoonAfterItsReturn) {
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(30, 10)) << harness.process().Err();
  const std::size_t before = harness.events().size();
  harness.left().Die();
  EXPECT_TRUE(harness.Receive(4, [&] { return CountSingles(harness, before) > 45; }));
  EXPECT_TRUE(harness.Receive(
      2, [&] { return harness.status().state == service_status_t::STATE_DEGRADED; }));
  EXPECT_THAT(harness.status().state_text, HasSubstr("left camera: "));
  EXPECT_THAT(harness.status().state_text, HasSubstr("LEFT"));

  harness.left().Return();
  const double returned_s = MonotonicSeconds();
  ASSERT_TRUE(harness.ReceivePairs(1, 5));
  const double resumed_s = MonotonicSeconds() - returned_s;
  std::printf("pairs %.2f s after it returned\n", resumed_s);
  EXPECT_LT(resumed_s, 1.0 + 0.2);  // and the clock's settling
  ASSERT_TRUE(harness.ReceivePairs(30, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
  // The right camera kept its rate: what was missing is the time until the left one was given up.
  EXPECT_LT(LongestRightGap(harness, before), 0.3 + 0.2);
  EXPECT_TRUE(harness.Receive(2.5, [&] {
    return harness.status().state == service_status_t::STATE_RUNNING &&
           harness.Counter("left_connects") == 2;
  })) << harness.status().state_text;
  EXPECT_GE(harness.Counter("left_stalls"), 1);
  EXPECT_EQ(harness.Counter("right_connects"), 1);
}

TEST_F(CaptureAwayTest, ACameraThatReturnsWithAnotherAddressIsFoundByItsSerial) {
  options_.right.address = "127.0.0.3";
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(10, 10)) << harness.process().Err();
  harness.left().Die();
  harness.Receive(0.5);
  harness.left().Return("127.0.0.2");
  const double returned_s = MonotonicSeconds();
  ASSERT_TRUE(harness.ReceivePairs(1, 5));
  const double resumed_s = MonotonicSeconds() - returned_s;
  std::printf("pairs %.2f s after it returned\n", resumed_s);
  EXPECT_LT(resumed_s, 1.0 + 0.2);
  ASSERT_TRUE(harness.ReceivePairs(10, 3));
  EXPECT_EQ(harness.num_wrong(), 0);
}

}  // namespace
}  // namespace visavis
