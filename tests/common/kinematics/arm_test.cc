#include "common/kinematics/arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/kinematics/hand_eye.h"
#include "tests/common/kinematics/test_arm.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const Eigen::Vector3d kPoint(0.03, -0.11, 0.07);

TEST(ArmTest, KinematicsAreTheProductOfExponentials) {
  Random random(1);
  for (int n = 1; n <= 12; ++n) {
    const TestArm test_arm = TestArm::Random(n, &random);
    SCOPED_TRACE(test_arm.Urdf());
    const Arm arm = test_arm.Build();
    for (int i = 0; i < 10; ++i) {
      const Eigen::VectorXd q = RandomJoints(arm.num_joints(), &random);
      const TestArm::Kinematics expected = test_arm.Compute(q, kPoint);
      EXPECT_LT(MaxDifference(arm.ForwardKinematics(q), expected.X_BH), 1e-13 * n);
      EXPECT_LT((arm.Jacobian(q, kPoint) - expected.J).cwiseAbs().maxCoeff(), 1e-13 * n);
    }
  }
}

// v = d/dt p_BP and [w x] = R' R^T, by central differences of the forward kinematics.
TEST(ArmTest, JacobianMatchesFiniteDifferences) {
  Random random(2);
  const double h = 1e-6;
  const Arm arm = TestArm::Random(9, &random).Build();
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = RandomJoints(arm.num_joints(), &random);
    const Eigen::VectorXd qdot = RandomJoints(arm.num_joints(), &random);
    const RigidTransform X = arm.ForwardKinematics(q), before = arm.ForwardKinematics(q - h * qdot),
                         after = arm.ForwardKinematics(q + h * qdot);
    const Eigen::Matrix3d w_cross =
        (after.linear() - before.linear()) / (2 * h) * X.linear().transpose();
    Vector6d expected;
    expected << (after * kPoint - before * kPoint) / (2 * h), w_cross(2, 1), w_cross(0, 2),
        w_cross(1, 0);
    EXPECT_LT((arm.Jacobian(q, kPoint) * qdot - expected).norm(), 1e-7);
  }
}

TEST(ArmTest, PointDefaultsToTheHandsOrigin) {
  Random random(3);
  const Arm arm = TestArm::Random(5, &random).Build();
  const Eigen::VectorXd q = RandomJoints(arm.num_joints(), &random);
  EXPECT_EQ(arm.Jacobian(q), arm.Jacobian(q, Eigen::Vector3d::Zero()));
}

TEST(ArmTest, JointsKeepOrderNamesKindsAndLimits) {
  const Eigen::Vector3d o(0, 0, 0.1), z(0, 0, 1);
  const TestArm test_arm{
      {{"continuous", o, o, z}, {"fixed", o, o, z}, {"prismatic", o, o, z}, {"revolute", o, o, z}}};
  const Arm arm = test_arm.Build();
  ASSERT_EQ(arm.num_joints(), 3);
  EXPECT_EQ(arm.joints()[0].name, "j1");
  EXPECT_EQ(arm.joints()[0].type, JointType::kContinuous);
  EXPECT_EQ(arm.joints()[0].upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(arm.joints()[1].name, "j3");
  EXPECT_EQ(arm.joints()[1].type, JointType::kPrismatic);
  EXPECT_EQ(arm.joints()[2].name, "j4");
  EXPECT_EQ(arm.joints()[2].type, JointType::kRevolute);
  EXPECT_EQ(arm.joints()[2].lower, -3);
  EXPECT_EQ(arm.joints()[2].upper, 2);
  EXPECT_EQ(arm.joints()[2].max_speed, 1.5);
}

TEST(ArmTest, FindsTheFirstJointBeyondItsLimits) {
  const Eigen::Vector3d o(0, 0, 0.1), z(0, 0, 1);
  const Arm arm =
      TestArm{{{"continuous", o, o, z}, {"prismatic", o, o, z}, {"revolute", o, o, z}}}.Build();
  EXPECT_EQ(arm.FindJointBeyondLimits(Eigen::Vector3d(99, 2, -3)), -1);
  EXPECT_EQ(arm.FindJointBeyondLimits(Eigen::Vector3d(0, 0, 2.001)), 2);
  EXPECT_EQ(arm.FindJointBeyondLimits(Eigen::Vector3d(0, 0, 2.001), 0.01), -1);
  EXPECT_EQ(arm.FindJointBeyondLimits(Eigen::Vector3d(0, std::nan(""), 9)), 1);
}

TEST(ArmTest, TakesAPartOfALongerArm) {
  Random random(4);
  TestArm test_arm = TestArm::Random(6, &random);
  const Arm part(test_arm.Urdf(), "l0", "l3");
  test_arm.joints.resize(3);
  const Eigen::VectorXd q = RandomJoints(part.num_joints(), &random);
  EXPECT_LT(MaxDifference(part.ForwardKinematics(q), test_arm.Build().ForwardKinematics(q)), 1e-14);
}

TEST(ArmTest, RefusesAJointVectorOfAnotherSize) {
  Random random(5);
  const Arm arm = TestArm{{{"revolute", kPoint, kPoint, kPoint}}}.Build();
  EXPECT_THAT([&] { arm.ForwardKinematics(Eigen::Vector2d(0, 0)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("q.size() = 2")));
  EXPECT_THROW(arm.Jacobian(Eigen::VectorXd()), std::invalid_argument);
}

struct HandEyeTest : ::testing::Test {
  Random random{6};
  TestArm test_arm{TestArm::Random(8, &random)};
  RigidTransform X_WB{MakeTransform(RotationFromAngles({0.4, -0.3, 1.2}), {1, -2, 0.5})};
  RigidTransform X_HC{MakeTransform(RotationFromAngles({-1.4, 0.2, 0.1}), {0.05, 0.07, -0.03})};
  HandEye hand_eye{test_arm.Build(), X_WB, X_HC};
  Eigen::VectorXd q{RandomJoints(hand_eye.arm().num_joints(), &random)};
};

TEST_F(HandEyeTest, CameraHangsOnTheHand) {
  const RigidTransform expected = X_WB * test_arm.Compute(q, {0, 0, 0}).X_BH * X_HC;
  EXPECT_LT(MaxDifference(hand_eye.CameraPose(q), expected), 1e-12);
}

TEST_F(HandEyeTest, HandPoseForIsTheInverseOfCameraPose) {
  EXPECT_LT(MaxDifference(hand_eye.HandPoseFor(hand_eye.CameraPose(q)),
                          hand_eye.arm().ForwardKinematics(q)),
            1e-12);
}

// Eqs. 4 and 5 for the camera's own origin, in the world.
TEST_F(HandEyeTest, CameraJacobianMatchesFiniteDifferences) {
  const double h = 1e-6;
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd qdot = RandomJoints(hand_eye.arm().num_joints(), &random);
    const RigidTransform X = hand_eye.CameraPose(q), before = hand_eye.CameraPose(q - h * qdot),
                         after = hand_eye.CameraPose(q + h * qdot);
    const Eigen::Matrix3d w_cross =
        (after.linear() - before.linear()) / (2 * h) * X.linear().transpose();
    Vector6d expected;
    expected << (after.translation() - before.translation()) / (2 * h), w_cross(2, 1),
        w_cross(0, 2), w_cross(1, 0);
    EXPECT_LT((hand_eye.CameraJacobian(q) * qdot - expected).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace visavis
