#include "services/recogniser/arm_clock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace visavis {
namespace {

using ::testing::HasSubstr;

TEST(ArmClockTest, AnOffsetUpToTheBoundIsAcceptedAndABitMoreIsNot) {
  ArmClock clock(5);
  EXPECT_TRUE(clock.Accepts(0));
  EXPECT_TRUE(clock.Accepts(0.00499));
  EXPECT_FALSE(clock.Accepts(0.00501));
  EXPECT_FALSE(clock.Accepts(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(clock.num_refused(), 2);
}

TEST(ArmClockTest, TheOffsetsSignIsOfNoConcern) {
  ArmClock clock(5);
  EXPECT_TRUE(clock.Accepts(-0.004));
  EXPECT_FALSE(clock.Accepts(-0.006));
}

TEST(ArmClockTest, AnUnknownOffsetIsAccepted) {
  ArmClock clock(5);
  EXPECT_TRUE(clock.Accepts(std::nan("")));
  EXPECT_EQ(clock.complaint(), "");
}

TEST(ArmClockTest, Bound0AcceptsAll) {
  ArmClock clock(0);
  EXPECT_TRUE(clock.Accepts(3600));
}

TEST(ArmClockTest, TheComplaintNamesFieldValueRuleAndEndsWithTheNextGoodState) {
  ArmClock clock(5);
  EXPECT_EQ(clock.complaint(), "");
  clock.Accepts(0.0123);
  EXPECT_THAT(clock.complaint(), HasSubstr("arm_state_t.clock_offset_s: 0.0123: must be at most "
                                           "0.005 (arm_clock_bound_ms)"));
  clock.Accepts(0.001);
  EXPECT_EQ(clock.complaint(), "");
}

TEST(ArmClockTest, OffsetsThatAreRefusedInARowAreOneComplaint) {
  ArmClock clock(5);
  clock.Accepts(0.006);
  const std::string first = clock.complaint();
  clock.Accepts(-0.007);
  EXPECT_EQ(clock.complaint(), first);
  EXPECT_EQ(clock.num_refused(), 2);
  clock.Accepts(0.001);
  clock.Accepts(0.007);
  EXPECT_THAT(clock.complaint(), HasSubstr("clock_offset_s: 0.007: "));
}

}  // namespace
}  // namespace visavis
