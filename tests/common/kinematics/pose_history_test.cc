#include "common/kinematics/pose_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/geometry/head_angles.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;

constexpr std::int64_t kMs = 1000;  // [us]
const Vector3d kVelocity(0.3, -0.2, 0.1), kSpin(0.5, 1.0, -0.7);

/// A camera in steady motion.
RigidTransform Pose(double t) {
  return MakeTransform(Eigen::Matrix3d(ExpRotation(t * kSpin) * RotationFromAngles({1, 0.3, -2})),
                       Vector3d(1, 2, 3) + t * kVelocity);
}

/// Poses at about 15 Hz from time 0 to 0.335 s.
PoseHistory Filled() {
  PoseHistory history;
  for (int i = 0; i < 6; ++i) history.Add(i * 67 * kMs, Pose(i * 0.067));
  return history;
}

double MaxDifference(const RigidTransform& X_1, const RigidTransform& X_2) {
  return (X_1.matrix() - X_2.matrix()).cwiseAbs().maxCoeff();
}

TEST(PoseHistoryTest, SteadyMotionIsInterpolatedExactlyWithItsTwist) {
  const PoseHistory history = Filled();
  for (int us = 0; us <= 335'000; us += 1234) {
    const auto state = history.At(us);
    ASSERT_TRUE(state);
    EXPECT_LT(MaxDifference(state->X_WC, Pose(us * 1e-6)), 1e-13);
    EXPECT_TRUE(state->has_twist);
    EXPECT_LT((state->twist.v_WC - kVelocity).norm(), 1e-12);
    EXPECT_LT((state->twist.w_WC - kSpin).norm(), 1e-12);
    EXPECT_FALSE(state->extrapolated);
    EXPECT_EQ(state->age_us, us % 67'000);
  }
}

TEST(PoseHistoryTest, PoseAtItsTimeIsGivenBackBitForBit) {
  const PoseHistory history = Filled();
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(history.At(i * 67 * kMs)->X_WC.matrix(), Pose(i * 0.067).matrix());
  }
}

TEST(PoseHistoryTest, ExtrapolationGoesOnSteadilyAndIsFlagged) {
  const PoseHistory history = Filled();
  const auto state = history.At(390 * kMs);
  ASSERT_TRUE(state);
  EXPECT_TRUE(state->extrapolated);
  EXPECT_EQ(state->age_us, 55 * kMs);
  EXPECT_LT(MaxDifference(state->X_WC, Pose(0.39)), 1e-13);
  EXPECT_FALSE(history.At(403 * kMs));
}

TEST(PoseHistoryTest, RotationTakesTheShortestArc) {
  PoseHistory history;
  const auto about_z = [](double deg) {
    return MakeTransform(ExpRotation({0, 0, deg * M_PI / 180}), Vector3d(0, 0, 0));
  };
  history.Add(0, about_z(170));
  history.Add(100 * kMs, about_z(-170));
  EXPECT_LT(MaxDifference(history.At(50 * kMs)->X_WC, about_z(180)), 1e-12);
}

TEST(PoseHistoryTest, LonePoseHasNoTwist) {
  PoseHistory history;
  history.Add(0, Pose(0));
  const auto state = history.At(0);
  ASSERT_TRUE(state);
  EXPECT_FALSE(state->has_twist);
  EXPECT_TRUE(state->twist.v_WC.isZero());
  EXPECT_TRUE(state->twist.w_WC.isZero());
}

TEST(PoseHistoryTest, RefusesAndCountsPosesThatAreNone) {
  PoseHistory history = Filled();
  RigidTransform not_finite = Pose(1), scaled = Pose(1), mirrored = Pose(1);
  not_finite.translation().y() = std::numeric_limits<double>::quiet_NaN();
  scaled.linear() *= 1.001;
  mirrored.linear().col(0) *= -1;
  EXPECT_EQ(history.Add(999 * kMs, not_finite), SampleVerdict::kNotFinite);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("not finite at utime = 999000"));
  EXPECT_EQ(history.Add(999 * kMs, scaled), SampleVerdict::kNotRigid);
  EXPECT_EQ(history.Add(999 * kMs, mirrored), SampleVerdict::kNotRigid);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("must have a rotation matrix"));
  EXPECT_EQ(history.Add(335 * kMs, Pose(1)), SampleVerdict::kDuplicate);
  EXPECT_EQ(history.Add(334 * kMs, Pose(1)), SampleVerdict::kOutOfOrder);
  EXPECT_THAT(history.DescribeLastRejection(), HasSubstr("334000 is before the newest"));
  EXPECT_EQ(history.counts().rejected(), 5);
  EXPECT_EQ(history.newest_us(), 335 * kMs);
}

TEST(PoseHistoryTest, JumpBackByMoreThanASecondForgetsTheSessionBefore) {
  PoseHistory history;
  history.Add(5000 * kMs, Pose(5));
  EXPECT_EQ(history.Add(3000 * kMs, Pose(3)), SampleVerdict::kAccepted);
  EXPECT_EQ(history.counts().restarts, 1);
  EXPECT_FALSE(history.At(5000 * kMs));
  EXPECT_TRUE(history.At(3000 * kMs));
}

}  // namespace
}  // namespace visavis
