#include "common/kinematics/inverse_kinematics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "tests/common/kinematics/demo_paths.h"
#include "tests/common/kinematics/test_arm.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

struct InverseKinematicsTest : ::testing::Test {
  HandEye hand_eye{LoadDemoHandEye()};
  const Arm& arm{hand_eye.arm()};
  InverseKinematics ik{arm, DemoPosture()};
  Random random{1};

  /// Within 85 % of the limits.
  Eigen::VectorXd RandomPosture() {
    Eigen::VectorXd q(arm.num_joints());
    for (int i = 0; i < arm.num_joints(); ++i) {
      q[i] = random.Uniform(0.85 * arm.joints()[i].lower, 0.85 * arm.joints()[i].upper);
    }
    return q;
  }
};

TEST_F(InverseKinematicsTest, FindsPosesWithin03RadOfTheStart) {
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = RandomPosture();
    const Eigen::VectorXd start =
        q + Eigen::VectorXd::NullaryExpr(7, [&] { return random.Uniform(-0.3, 0.3); });
    const RigidTransform X_BH = arm.ForwardKinematics(q);
    InverseKinematics near(arm, q);
    const auto solution = near.Solve(X_BH, start);
    ASSERT_TRUE(solution.ok()) << solution.problem;
    EXPECT_LT(MaxDifference(arm.ForwardKinematics(solution.q), X_BH), 1e-9);
    EXPECT_LT(solution.position_error_m, 1e-9);
    EXPECT_LT(solution.angle_error_rad, 1e-9);
  }
}

// Of all joint positions with this pose the nearest to the preferred one: its way there has no part
// that keeps the pose.
TEST_F(InverseKinematicsTest, RedundantArmStaysAsNearThePreferredPostureAsThePoseAllows) {
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd offset =
        Eigen::VectorXd::NullaryExpr(7, [&] { return random.Uniform(-0.2, 0.2); });
    const auto solution = ik.Solve(arm.ForwardKinematics(DemoPosture() + offset), DemoPosture());
    ASSERT_TRUE(solution.ok()) << solution.problem;
    const Eigen::MatrixXd J = arm.Jacobian(solution.q);
    const Eigen::VectorXd wish = DemoPosture() - solution.q;
    const Eigen::VectorXd null_part =
        wish - J.transpose() * (J * J.transpose()).inverse() * (J * wish);
    EXPECT_LT(null_part.norm(), 1e-9);
    EXPECT_LE(wish.norm(), offset.norm() + 1e-9);
  }
}

TEST_F(InverseKinematicsTest, SolutionDependsOnThePoseAndNotOnTheWayThere) {
  const auto there = ik.SolvePath(HandPath(hand_eye, ShuttleX, 50));
  const auto alone = ik.Solve(hand_eye.HandPoseFor(ShuttleX(0.3)), DemoPosture());
  ASSERT_THAT(there.unreached, IsEmpty());
  EXPECT_LT((there.q.col(15) - alone.q).norm(), 1e-9);
}

TEST_F(InverseKinematicsTest, PeriodicPathOfTheHandIsAPeriodicPathOfTheJoints) {
  const auto path = ik.SolvePath(HandPath(hand_eye, OrbitTheta, 100));
  ASSERT_THAT(path.unreached, IsEmpty());
  EXPECT_LT((path.q.col(0) - path.q.col(100)).norm(), 1e-9);
}

TEST_F(InverseKinematicsTest, PosesOutOfReachAreNamedAndTheOthersSolved) {
  auto X_BH = HandPath(hand_eye, ShuttleX, 10);
  X_BH[4].translation() += Eigen::Vector3d(0, 0, 2);
  const JointPath path = ik.SolvePath(X_BH);
  ASSERT_THAT(path.unreached, SizeIs(1));
  EXPECT_EQ(path.unreached[0].index, 4);
  EXPECT_THAT(path.unreached[0].reason, AllOf(HasSubstr("mm and"), HasSubstr("deg off")));
  EXPECT_THAT(path.Describe(), HasSubstr("1 of 11 poses not reached: pose 4: "));
  for (int i = 0; i < 11; ++i) EXPECT_EQ(path.q.col(i).allFinite(), i != 4);
}

TEST_F(InverseKinematicsTest, PosesBeyondALimitAreNamedByJoint) {
  Eigen::VectorXd q = DemoPosture();
  q[3] = 2.5;  // joint_4 ends at 2.35; this reach needs an elbow angle of 2.5
  const auto solution = ik.Solve(arm.ForwardKinematics(q), q);
  EXPECT_THAT(solution.problem, AllOf(HasSubstr("joint 'joint_4' = 2.5"),
                                      HasSubstr("must be within -2.3500 to 2.3500")));
}

TEST_F(InverseKinematicsTest, JumpsOfAPathAreNamed) {
  auto X_BH = HandPath(hand_eye, ShuttleX, 20);
  X_BH.erase(X_BH.begin() + 1, X_BH.begin() + 10);
  const JointPath path = ik.SolvePath(X_BH);
  ASSERT_THAT(path.unreached, SizeIs(1));
  EXPECT_EQ(path.unreached[0].index, 1);
  EXPECT_THAT(path.unreached[0].reason, AllOf(HasSubstr("jumps by"), HasSubstr("at most 0.5")));
}

TEST_F(InverseKinematicsTest, NotANumberIsAProblemAndNotASolution) {
  RigidTransform X_BH = hand_eye.HandPoseFor(DemoCameraPose());
  X_BH.translation().x() = std::nan("");
  EXPECT_FALSE(ik.Solve(X_BH, DemoPosture()).ok());
}

TEST_F(InverseKinematicsTest, ArmWithTooFewJointsReachesOnlyItsOwnPoses) {
  Random any(3);
  const Eigen::Vector3d o(0.2, 0, 0.1), zero(0, 0, 0);
  const TestArm three{{{"revolute", o, zero, {0, 0, 1}},
                       {"revolute", o, zero, {0, 1, 0}},
                       {"prismatic", o, zero, {1, 0, 0}}}};
  const Arm small = three.Build();
  InverseKinematics small_ik(small, Eigen::Vector3d(0.1, 0.2, 0.3));
  const Eigen::Vector3d q(0.3, -0.1, 0.5);
  const auto solution = small_ik.Solve(small.ForwardKinematics(q), Eigen::Vector3d(0.2, 0, 0.4));
  ASSERT_TRUE(solution.ok()) << solution.problem;
  EXPECT_LT((solution.q - q).norm(), 1e-9);
  RigidTransform rolled = small.ForwardKinematics(q);
  rolled.linear() = rolled.linear() * ExpRotation({0.1, 0, 0});
  EXPECT_FALSE(small_ik.Solve(rolled, q).ok());
}

TEST_F(InverseKinematicsTest, RefusesAPreferredPostureThatTheArmCannotTake) {
  Eigen::VectorXd q = DemoPosture();
  q[5] = 3;
  EXPECT_THAT([&] { InverseKinematics(arm, q); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("joint_6")));
  EXPECT_THROW(InverseKinematics(arm, Eigen::Vector3d(0, 0, 0)), std::invalid_argument);
  EXPECT_THROW(ik.Solve(RigidTransform::Identity(), Eigen::Vector3d(0, 0, 0)),
               std::invalid_argument);
}

}  // namespace
}  // namespace visavis
