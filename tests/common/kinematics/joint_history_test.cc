#include "common/kinematics/joint_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace visavis {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kMs = 1000;  // [us]
const std::vector<std::string> kNames{"a", "b"};

/// Cubics in time, one a joint.
Vector2d Q(double t) { return {1 + t - 2 * t * t + 5 * t * t * t, -3 * t}; }
Vector2d Qdot(double t) { return {1 - 4 * t + 15 * t * t, -3}; }

/// Six samples of the cubics, every 20 ms from time 0.
JointHistory Filled() {
  JointHistory history(kNames);
  for (int i = 0; i < 6; ++i) history.Add(i * 20 * kMs, kNames, Q(i * 0.02), Qdot(i * 0.02));
  return history;
}

TEST(JointHistoryTest, CubicMotionIsInterpolatedExactly) {
  const JointHistory history = Filled();
  for (int us = 0; us <= 100'000; us += 777) {
    const auto sample = history.At(us);
    ASSERT_TRUE(sample);
    EXPECT_LT((sample->q - Q(us * 1e-6)).norm(), 1e-14);
    EXPECT_LT((sample->qdot - Qdot(us * 1e-6)).norm(), 1e-12);
    EXPECT_FALSE(sample->extrapolated);
    EXPECT_EQ(sample->age_us, us % 20'000);
  }
}

TEST(JointHistoryTest, SampleAtItsTimeIsGivenBackBitForBit) {
  const JointHistory history = Filled();
  for (int i = 0; i < 6; ++i) {
    const auto sample = history.At(i * 20 * kMs);
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->q, Q(i * 0.02));
    EXPECT_EQ(sample->qdot, Qdot(i * 0.02));
  }
}

TEST(JointHistoryTest, ExtrapolationGoesOnAtTheLastVelocityAndIsFlagged) {
  const JointHistory history = Filled();
  const auto sample = history.At(115 * kMs);
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->extrapolated);
  EXPECT_EQ(sample->age_us, 15 * kMs);
  EXPECT_LT((sample->q - (Q(0.1) + 0.015 * Qdot(0.1))).norm(), 1e-14);
  EXPECT_EQ(sample->qdot, Qdot(0.1));
  EXPECT_FALSE(history.At(121 * kMs));
}

TEST(JointHistoryTest, JointsMayComeInAnyOrderAndAmongOthers) {
  JointHistory history(kNames);
  EXPECT_EQ(history.Add(0, {"b", "finger", "a"}, Vector3d(2, kNan, 1), Vector3d(20, 0, 10)),
            SampleVerdict::kAccepted);
  EXPECT_EQ(history.At(0)->q, Vector2d(1, 2));
  EXPECT_EQ(history.At(0)->qdot, Vector2d(10, 20));
}

TEST(JointHistoryTest, RefusesNamesThatAreNotTheArms) {
  JointHistory history(kNames);
  const Vector2d q(1, 2), qdot(0, 0);
  EXPECT_EQ(history.Add(0, {"a", "c"}, q, qdot), SampleVerdict::kWrongNames);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("must name 'b' once"));
  EXPECT_EQ(history.Add(1, {"a", "b", "a"}, Vector3d(1, 2, 3), Vector3d(0, 0, 0)),
            SampleVerdict::kWrongNames);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("must name 'a' once"));
  EXPECT_EQ(history.Add(2, {"a"}, q.head<1>(), qdot.head<1>()), SampleVerdict::kWrongNames);
  EXPECT_EQ(history.Add(3, kNames, q.head<1>(), qdot), SampleVerdict::kWrongNames);
  EXPECT_EQ(history.Add(4, kNames, q, qdot.head<1>()), SampleVerdict::kWrongNames);
  EXPECT_EQ(history.Add(5, {}, Eigen::VectorXd(), Eigen::VectorXd()), SampleVerdict::kWrongNames);
  EXPECT_EQ(history.counts().wrong_names, 6);
  EXPECT_FALSE(history.newest_us());
}

TEST(JointHistoryTest, RefusesNumbersThatAreNotFinite) {
  JointHistory history(kNames);
  for (const double bad : {kNan, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(history.Add(7, kNames, Vector2d(1, bad), Vector2d(0, 0)), SampleVerdict::kNotFinite);
    EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("joint 'b': position or velocity"));
    EXPECT_EQ(history.Add(7, kNames, Vector2d(1, 2), Vector2d(bad, 0)), SampleVerdict::kNotFinite);
    EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("joint 'a'"));
  }
  EXPECT_EQ(history.counts().not_finite, 4);
  EXPECT_EQ(history.counts().accepted, 0);
}

TEST(JointHistoryTest, RejectedSamplesAreCountedAndChangeNothing) {
  JointHistory history = Filled();
  const Vector2d other(9, 9);
  EXPECT_EQ(history.Add(100 * kMs, kNames, other, other), SampleVerdict::kDuplicate);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("utime = 100000 repeats"));
  EXPECT_EQ(history.Add(50 * kMs, kNames, other, other), SampleVerdict::kOutOfOrder);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("50000 is before the newest"));
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("100000, must be later"));
  EXPECT_EQ(history.counts().duplicate, 1);
  EXPECT_EQ(history.counts().out_of_order, 1);
  EXPECT_EQ(history.counts().accepted, 6);
  EXPECT_EQ(history.At(100 * kMs)->q, Q(0.1));
  EXPECT_LT((history.At(50 * kMs)->q - Q(0.05)).norm(), 1e-14);
}

TEST(JointHistoryTest, JumpBackByMoreThanASecondForgetsTheSessionBefore) {
  JointHistory history(kNames);
  history.Add(5000 * kMs, kNames, Q(0), Qdot(0));
  history.Add(5020 * kMs, kNames, Q(0), Qdot(0));
  EXPECT_EQ(history.Add(1000 * kMs, kNames, Q(0.1), Qdot(0.1)), SampleVerdict::kAccepted);
  EXPECT_EQ(history.counts().restarts, 1);
  EXPECT_EQ(history.newest_us(), 1000 * kMs);
  EXPECT_FALSE(history.At(5010 * kMs));
  EXPECT_EQ(history.At(1000 * kMs)->q, Q(0.1));
}

TEST(JointHistoryTest, ClearForgetsSamplesAndKeepsCounts) {
  JointHistory history = Filled();
  history.Clear();
  EXPECT_FALSE(history.At(40 * kMs));
  EXPECT_EQ(history.counts().accepted, 6);
  EXPECT_EQ(history.DescribeLastRejection(), "");
}

TEST(JointHistoryTest, RefusesToBeMadeForNoJoints) {
  EXPECT_THROW(JointHistory({}), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
