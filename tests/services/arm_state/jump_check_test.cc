#include "services/arm_state/jump_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using Verdict = JumpCheck::Verdict;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

JumpOptions Options() {
  JumpOptions options;
  options.speed_factor = 2;
  options.time_slack_s = 0.001;
  options.slack = 0.01;
  options.beyond_limits = 0.05;
  options.follow_after = 3;
  return options;
}

/// Shoulder: 1 rad/s, within +-2; wheel: no limits at all.
class JumpCheckTest : public ::testing::Test {
 protected:
  Verdict Judge(std::int64_t utime_us, double shoulder, double wheel = 0) {
    JointVector q(2);
    q << shoulder, wheel;
    return check_.Judge(utime_us, q);
  }
  bool Speeds(double shoulder) {
    JointVector qdot(2);
    qdot << shoulder, 1e9;
    return check_.AreSpeedsPossible(qdot);
  }
  JumpCheck check_{{{"shoulder", JointType::kRevolute, -2, 2, 1},
                    {"wheel", JointType::kContinuous, -kInfinity, kInfinity, kInfinity}},
                   Options()};
};

// 2 * 1 rad/s * (10 ms + 1 ms) + 0.01 = 0.032 rad.
TEST_F(JumpCheckTest, AWayThatTheSpeedLimitAllowsIsTakenAndALongerOneIsNot) {
  EXPECT_EQ(Judge(1'000'000, 0.5), Verdict::kPossible);
  EXPECT_EQ(Judge(1'010'000, 0.5319), Verdict::kPossible);
  EXPECT_EQ(Judge(1'020'000, 0.5), Verdict::kPossible);
  EXPECT_EQ(Judge(1'030'000, 0.5321), Verdict::kRefused);
  EXPECT_THAT(check_.refusal(),
              HasSubstr("position of 'shoulder': 0.5321 after 0.5: 0.01 s apart"));
  EXPECT_THAT(check_.refusal(), HasSubstr("within 0.032"));
}

TEST_F(JumpCheckTest, OneBadReadingDoesNotSpoilTheNext) {
  Judge(1'000'000, 0.5);
  EXPECT_EQ(Judge(1'010'000, -1.5), Verdict::kRefused);
  EXPECT_EQ(Judge(1'020'000, 0.51), Verdict::kPossible);
}

TEST_F(JumpCheckTest, AfterAGapALongerWayIsPossible) {
  Judge(1'000'000, 0.5);
  EXPECT_EQ(Judge(1'500'000, 1.4), Verdict::kPossible);
}

TEST_F(JumpCheckTest, AnArmThatStaysElsewhereIsFollowed) {
  Judge(1'000'000, 0.5);
  EXPECT_EQ(Judge(1'010'000, -1.5), Verdict::kRefused);
  EXPECT_EQ(Judge(1'020'000, -1.51), Verdict::kRefused);
  EXPECT_EQ(Judge(1'030'000, -1.5), Verdict::kJumpFollowed);
  EXPECT_EQ(Judge(1'040'000, -1.5), Verdict::kPossible);
}

TEST_F(JumpCheckTest, ReadingsThatDoNotAgreeAreNeverFollowed) {
  Judge(1'000'000, 0.5);
  for (int i = 1; i <= 20; ++i)
    EXPECT_EQ(Judge(1'000'000 + 1000 * i, i % 2 ? -1.5 : 1.5), Verdict::kRefused);
}

TEST_F(JumpCheckTest, PositionsOutsideTheLimitsAreRefusedAlwaysAndWithTheLimits) {
  EXPECT_EQ(Judge(1'000'000, 2.04), Verdict::kPossible);
  for (int i = 1; i <= 10; ++i) EXPECT_EQ(Judge(1'000'000 + i, 2.06), Verdict::kRefused);
  EXPECT_THAT(check_.refusal(), HasSubstr("position of 'shoulder': 2.06: must be -2 to 2"));
  EXPECT_EQ(Judge(2'000'000, -57.3), Verdict::kRefused);  // degrees
}

TEST_F(JumpCheckTest, AJointWithoutLimitsMayDoAnything) {
  Judge(1'000'000, 0, 0);
  EXPECT_EQ(Judge(1'001'000, 0, 1e6), Verdict::kPossible);
}

TEST_F(JumpCheckTest, ImpossibleSpeedsAreRefused) {
  EXPECT_TRUE(Speeds(2));
  EXPECT_FALSE(Speeds(-2.1));
  EXPECT_THAT(check_.refusal(), HasSubstr("velocity of 'shoulder': -2.1: must be at most 2.01"));
}

TEST_F(JumpCheckTest, AfterAResetAnyPlaceIsPossible) {
  Judge(1'000'000, 0.5);
  check_.Reset();
  EXPECT_EQ(Judge(1'001'000, -1.5), Verdict::kPossible);
}

}  // namespace
}  // namespace visavis
