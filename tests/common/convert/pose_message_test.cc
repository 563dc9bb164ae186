#include "common/convert/pose_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/convert/message_error.h"
#include "common/core/random.h"
#include "common/geometry/head_angles.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

RigidTransform RandomPose(Random* random) {
  Vector6d phi;
  for (int i = 0; i < 6; ++i) phi[i] = random->Uniform(-1.5, 1.5);
  return TransformFromPhi(phi);
}

TEST(PoseMessageTest, TransformsMakeTheRoundTrip) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform X = RandomPose(&random);
    const rigid_transform_t m = ToMessage(X, 77);
    EXPECT_EQ(m.utime, 77);
    EXPECT_LT((FromMessage(m).matrix() - X.matrix()).norm(), 1e-14);
  }
}

TEST(PoseMessageTest, TheQuaternionIsWrittenWFirstAndWPositive) {
  const RigidTransform X = MakeTransform(ExpRotation({0, 0, 0.2}), {1, 2, 3});
  const rigid_transform_t m = ToMessage(X, 0);
  EXPECT_NEAR(m.quat[0], std::cos(0.1), 1e-15);
  EXPECT_NEAR(m.quat[3], std::sin(0.1), 1e-15);
  EXPECT_EQ(m.trans[2], 3);
  Random random(2);
  for (int i = 0; i < 100; ++i) EXPECT_GE(ToMessage(RandomPose(&random), 0).quat[0], 0);
}

TEST(PoseMessageTest, AQuaternionNearNormOneIsNormalised) {
  rigid_transform_t m = ToMessage(RigidTransform::Identity(), 0);
  m.quat[0] = 1.0009;
  EXPECT_EQ(FromMessage(m).matrix(), RigidTransform::Identity().matrix());
}

TEST(PoseMessageTest, ALyingFieldIsNamedWithValueAndRule) {
  rigid_transform_t m = ToMessage(RigidTransform::Identity(), -1);
  EXPECT_THAT([&] { FromMessage(m); },
              ThrowsMessage<MessageError>("rigid_transform_t.utime: -1: must be >= 0"));
  m = ToMessage(RigidTransform::Identity(), 0);
  m.quat[0] = 0.5;
  m.quat[3] = 0.25;
  EXPECT_THAT([&] { FromMessage(m); },
              ThrowsMessage<MessageError>(AllOf(StartsWith("rigid_transform_t: "),
                                                HasSubstr("0.5    0    0 0.25"),
                                                HasSubstr("norm 1 within 0.001"))));
  m = ToMessage(RigidTransform::Identity(), 0);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e7}) {
    m.trans[1] = bad;
    EXPECT_THAT([&] { FromMessage(m); },
                ThrowsMessage<MessageError>(HasSubstr("position must be finite and below 1e6 m")));
  }
  m = ToMessage(RigidTransform::Identity(), 0);
  m.quat[2] = std::nan("");
  EXPECT_THROW(FromMessage(m), MessageError);
}

TEST(HeadPoseMessageTest, AnEmptyOneHoldsNoPose) {
  const head_pose_t m = EmptyHeadPose();
  EXPECT_FALSE(HasPose(m));
  EXPECT_THROW(FromMessage(m), MessageError);
  for (const double v :
       {m.p_CM_m[0], m.q_CM_wxyz[3], m.euler_zyx_CM_rad[1], m.covariance[0], m.covariance[35],
        m.p_WM_m[2], m.q_WM_wxyz[0], m.fitness, m.fitness_site, m.fitness_color, m.fitness_feat}) {
    EXPECT_TRUE(std::isnan(v));
  }
  EXPECT_EQ(m.status, head_pose_t::STATUS_SEARCHING);
  EXPECT_FALSE(m.has_world_pose);
}

TEST(HeadPoseMessageTest, SetPoseWritesPositionQuaternionAndAnglesOfOnePose) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const RigidTransform X_CM = RandomPose(&random);
    head_pose_t m = EmptyHeadPose();
    SetPose(X_CM, &m);
    EXPECT_TRUE(HasPose(m));
    EXPECT_LT((FromMessage(m).matrix() - X_CM.matrix()).norm(), 1e-14);
    const Eigen::Vector3d angles(m.euler_zyx_CM_rad);
    EXPECT_LT((RotationFromAngles(angles) - X_CM.linear()).norm(), 1e-13);
    EXPECT_TRUE(std::isnan(m.p_WM_m[0]));
  }
}

TEST(HeadPoseMessageTest, APoseWithOneNumberMissingIsNone) {
  head_pose_t m = EmptyHeadPose();
  SetPose(RigidTransform::Identity(), &m);
  EXPECT_TRUE(HasPose(m));
  m.q_CM_wxyz[2] = std::nan("");
  EXPECT_FALSE(HasPose(m));
  SetPose(RigidTransform::Identity(), &m);
  m.p_CM_m[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(HasPose(m));
}

TEST(HeadPoseMessageTest, TheWorldPoseStandsBesideThePoseInTheCamera) {
  head_pose_t m = EmptyHeadPose();
  SetWorldPose(MakeTransform(ExpRotation({0, 0.4, 0}), {1, 2, 3}), &m);
  EXPECT_TRUE(m.has_world_pose);
  EXPECT_EQ(m.p_WM_m[1], 2);
  EXPECT_NEAR(m.q_WM_wxyz[2], std::sin(0.2), 1e-15);
  EXPECT_FALSE(HasPose(m));
}

TEST(HeadPoseMessageTest, TruthIsTrackingWithAHeadAndLostWithout) {
  const RigidTransform X_CM = MakeTransform(ExpRotation({0.1, 0, 0}), {0, 0, 1});
  const head_pose_t seen = TruthMessage(5, 6, &X_CM);
  EXPECT_EQ(seen.utime, 5);
  EXPECT_EQ(seen.seq, 6);
  EXPECT_EQ(seen.status, head_pose_t::STATUS_TRACKING);
  EXPECT_LT((FromMessage(seen).matrix() - X_CM.matrix()).norm(), 1e-14);
  const head_pose_t away = TruthMessage(5, 6, nullptr);
  EXPECT_EQ(away.status, head_pose_t::STATUS_LOST);
  EXPECT_FALSE(HasPose(away));
}

}  // namespace
}  // namespace visavis
