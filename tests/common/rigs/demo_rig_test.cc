// The demo arm can do what the demo asks of it.

#include "common/rigs/demo_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cstdio>
#include <limits>

#include "common/kinematics/inverse_kinematics.h"
#include "tests/common/kinematics/demo_paths.h"

namespace visavis {
namespace {

using ::testing::IsEmpty;

struct DemoRigTest : ::testing::Test {
  HandEye hand_eye{LoadDemoHandEye()};
  const Arm& arm{hand_eye.arm()};
  InverseKinematics ik{arm, DemoPosture()};
};

TEST_F(DemoRigTest, HasSevenJointsWithinLimitsAtThePosture) {
  EXPECT_EQ(arm.num_joints(), 7);
  EXPECT_EQ(arm.FindJointBeyondLimits(DemoPosture()), -1);
  for (const ArmJoint& joint : arm.joints()) {
    EXPECT_EQ(joint.type, JointType::kRevolute);
    EXPECT_LT(joint.max_speed, 5) << joint.name;
  }
}

TEST_F(DemoRigTest, HandReaches092MetresFromTheShoulder) {
  const RigidTransform X_BH = arm.ForwardKinematics(Eigen::VectorXd::Zero(7));
  EXPECT_NEAR(X_BH.translation().z() - 0.31, 0.92, 1e-12);
}

TEST_F(DemoRigTest, PosturePutsTheCameraAtItsNominalPose) {
  const RigidTransform X_WC = hand_eye.CameraPose(DemoPosture());
  EXPECT_LT((X_WC.translation() - DemoCameraPose().translation()).norm(), 1e-3);
  EXPECT_LT(LogRotation(X_WC.linear().transpose() * DemoCameraPose().linear()).norm(),
            0.1 * M_PI / 180);
}

TEST_F(DemoRigTest, HandEyeIsFarFromIdentity) {
  EXPECT_GT(LogRotation(hand_eye.X_HC().linear()).norm(), 1);
  EXPECT_GT(LogRotation(hand_eye.X_WB().linear()).norm(), 0.5);
}

TEST_F(DemoRigTest, HeadStandsOneMetreInFrontOfTheCamera) {
  const RigidTransform X_CM = DemoCameraPose().inverse() * DemoHeadPose();
  EXPECT_LT((X_CM.translation() - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
  EXPECT_LT((X_CM.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-15);
}

/// What a turn of a camera path asks of the arm.
struct Demands {
  double min_manipulability{std::numeric_limits<double>::infinity()};    // sqrt(det(J J^T))
  double min_singular_value{std::numeric_limits<double>::infinity()};    // of J, m and rad mixed
  double min_limit_margin_rad{std::numeric_limits<double>::infinity()};  // to a joint's limit
  double max_turn_speed{0};   // [rad a turn] largest joint speed of a path that takes 1 s
  double max_speed_share{0};  // of the joint's limit, at 1 s a turn
  double position_error_mm{0}, angle_error_deg{0};
};

template <typename Path>
Demands DemandsOf(const char* name, DemoRigTest* test, const Path& path) {
  const int n = 200;
  const JointPath joints = test->ik.SolvePath(HandPath(test->hand_eye, path, n));
  EXPECT_THAT(joints.unreached, IsEmpty()) << joints.Describe();
  Demands d;
  d.position_error_mm = joints.max_position_error_m * 1e3;
  d.angle_error_deg = joints.max_angle_error_rad * 180 / M_PI;
  for (int i = 0; i <= n; ++i) {
    const Eigen::VectorXd q = joints.q.col(i);
    const Eigen::MatrixXd J = test->hand_eye.CameraJacobian(q);
    const Eigen::VectorXd singular = J.jacobiSvd().singularValues();
    d.min_manipulability = std::min(d.min_manipulability, singular.prod());
    d.min_singular_value = std::min(d.min_singular_value, singular[5]);
    for (int k = 0; k < 7; ++k) {
      const ArmJoint& joint = test->arm.joints()[k];
      d.min_limit_margin_rad =
          std::min({d.min_limit_margin_rad, q[k] - joint.lower, joint.upper - q[k]});
      if (i == 0) continue;
      const double speed = std::abs(q[k] - joints.q(k, i - 1)) * n;
      d.max_turn_speed = std::max(d.max_turn_speed, speed);
      d.max_speed_share = std::max(d.max_speed_share, speed / joint.max_speed);
    }
  }
  std::printf(
      "%-11s manipulability >= %.3f, singular value >= %.3f, limits %.2f rad away, fastest "
      "joint %.2f rad/s at T=7 s, %.2f rad/s at T=1 s (%.0f %% of its limit), residual "
      "%.1e mm %.1e deg\n",
      name, d.min_manipulability, d.min_singular_value, d.min_limit_margin_rad,
      d.max_turn_speed / 7, d.max_turn_speed, 100 * d.max_speed_share, d.position_error_mm,
      d.angle_error_deg);
  return d;
}

void ExpectComfortable(const Demands& d) {
  EXPECT_GT(d.min_manipulability, 0.05);
  EXPECT_GT(d.min_singular_value, 0.1);
  EXPECT_GT(d.min_limit_margin_rad, 0.15);
  EXPECT_LT(d.max_speed_share, 0.9);
  EXPECT_LT(d.position_error_mm, 0.01);
  EXPECT_LT(d.angle_error_deg, 0.001);
}

TEST_F(DemoRigTest, ShuttleLiesWellInsideTheWorkspaceEvenAtOneSecondATurn) {
  ExpectComfortable(DemandsOf("shuttle_x", this, ShuttleX));
}

TEST_F(DemoRigTest, OrbitLiesWellInsideTheWorkspaceEvenAtOneSecondATurn) {
  ExpectComfortable(DemandsOf("orbit_theta", this, OrbitTheta));
}

// Room for motions of one's own: 200 mm and 15 deg any way.
TEST_F(DemoRigTest, CameraCanGo200MillimetresAnyWayAndTurn15Degrees) {
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = -10; i <= 10; ++i) {
      RigidTransform moved = DemoCameraPose(), turned = DemoCameraPose();
      moved.translation()[axis] += 0.02 * i;
      turned.linear() =
          ExpRotation(Eigen::Vector3d::Unit(axis) * (1.5 * i * M_PI / 180)) * turned.linear();
      for (const RigidTransform& X_WC : {moved, turned}) {
        const auto solution = ik.Solve(hand_eye.HandPoseFor(X_WC), DemoPosture());
        EXPECT_TRUE(solution.ok()) << "axis " << axis << " step " << i << ": " << solution.problem;
      }
    }
  }
}

}  // namespace
}  // namespace visavis
