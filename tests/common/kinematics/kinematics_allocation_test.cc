// What runs per message or per frame allocates nothing after construction.

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/kinematics/camera_motion.h"
#include "tests/common/kinematics/demo_paths.h"
#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

/// Calls of malloc by @p step.
template <typename Step>
std::int64_t MallocsOf(const Step& step) {
  const std::int64_t before = NumMallocs();
  step();
  return NumMallocs() - before;
}

struct KinematicsAllocationTest : ::testing::Test {
  HandEye hand_eye{LoadDemoHandEye()};
  Eigen::VectorXd q{DemoPosture()};
  Eigen::VectorXd qdot{Eigen::VectorXd::Constant(7, 0.1)};
  double sum{0};  // of results, so that nothing is optimised away
};

TEST_F(KinematicsAllocationTest, CounterSeesEigensAllocations) {
  if (NumMallocs() < 0) GTEST_SKIP() << "mallocs are not counted here";
  EXPECT_GT(MallocsOf([&] {
              const Eigen::VectorXd heap = Eigen::VectorXd::Constant(1000, q[0]);
              sum += heap.maxCoeff();
            }),
            0);
}

TEST_F(KinematicsAllocationTest, ArmAndHandEyeAllocateNothing) {
  EXPECT_EQ(MallocsOf([&] {
              sum += hand_eye.arm().ForwardKinematics(q).translation().x();
              sum += hand_eye.arm().Jacobian(q, {0.1, 0.2, 0.3}).sum();
              sum += hand_eye.CameraPose(q).translation().x();
              sum += hand_eye.CameraJacobian(q).sum();
              sum += hand_eye.arm().FindJointBeyondLimits(q);
            }),
            0);
}

TEST_F(KinematicsAllocationTest, FeedforwardAllocatesNothing) {
  const RigidTransform X_WC = hand_eye.CameraPose(q);
  const RigidTransform X_C2C1 = CameraDisplacement(X_WC, hand_eye.CameraPose(q + 0.01 * qdot));
  Matrix6Xd population(6, 60);
  for (int i = 0; i < 60; ++i) population.col(i) << 0.001 * i, 0, 1, 0.1, -0.001 * i, 0.2;
  EXPECT_EQ(MallocsOf([&] {
              const JacobianMatrix J = hand_eye.CameraJacobian(q);
              const CameraTwist camera = TwistFromJoints(J, qdot);
              EulerStepAll(X_WC.linear(), camera, 0.03, population);
              CarryAll(X_C2C1, population);
              const Vector6d phi = population.col(0);
              const JacobianMatrix Jm = CameraMotionJacobian(phi, X_WC.linear(), J);
              sum += Jm.sum() + HeadMotionJacobian(phi, X_WC.linear()).sum();
            }),
            0);
}

TEST_F(KinematicsAllocationTest, JointHistoryAllocatesNothing) {
  std::vector<std::string> names;
  for (const ArmJoint& joint : hand_eye.arm().joints()) {
    names.push_back(joint.name + " with a name too long for the string's own memory");
  }
  JointHistory history(names, {64, 100'000});
  std::vector<std::string> wrong = names;
  wrong[3] = "another";
  EXPECT_EQ(MallocsOf([&] {
              for (int i = 0; i < 200; ++i) {  // more than the ring holds
                history.Add(10'000 * i, names, q, qdot);
                history.Add(10'000 * i, wrong, q, qdot);
                sum += history.At(10'000 * i - 3'000).has_value();
              }
            }),
            0);
  EXPECT_EQ(history.counts().accepted, 200);
  EXPECT_EQ(history.counts().wrong_names, 200);
}

TEST_F(KinematicsAllocationTest, CameraMotionAllocatesNothing) {
  std::vector<std::string> names;
  for (const ArmJoint& joint : hand_eye.arm().joints()) names.push_back(joint.name);
  ArmCameraMotion from_arm(hand_eye, {64, 100'000});
  PoseCameraMotion from_poses({64, 100'000});
  const RigidTransform X_WC = hand_eye.CameraPose(q);
  EXPECT_EQ(MallocsOf([&] {
              for (int i = 0; i < 200; ++i) {
                from_arm.Add(10'000 * i, names, q, qdot);
                from_poses.Add(10'000 * i, X_WC);
                sum += from_arm.At(10'000 * i - 3'000).has_value();
                sum += from_poses.At(10'000 * i - 3'000).has_value();
                sum += from_arm.At(10'000 * i + 3'000).has_value();
              }
            }),
            0);
  EXPECT_EQ(from_arm.counts().accepted, 200);
  EXPECT_EQ(from_poses.counts().accepted, 200);
}

}  // namespace
}  // namespace visavis
