#include "services/recogniser/refined/pose_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d RandomVector(Random* random) {
  return {random->Uniform(-1, 1), random->Uniform(-1, 1), random->Uniform(-1, 1)};
}

Vector6d RandomStep(Random* random, double size) {
  Vector6d step;
  step << RandomVector(random), RandomVector(random);
  return size * step;
}

TEST(MovedTest, APointMovesByTheStepToFirstOrder) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
    const Vector6d step = RandomStep(&random, 1e-4);
    const Vector3d p_M = 0.1 * RandomVector(&random);
    const Vector3d moved = Moved(X_CM, step) * p_M - X_CM * p_M;
    const Vector3d w = step.tail<3>();
    const Vector3d expected = step.head<3>() + w.cross(X_CM.linear() * p_M);
    EXPECT_LT((moved - expected).norm(), 1e-8);
  }
}

TEST(MovedTest, NoStepLeavesThePoseAndAPoseStaysRigid) {
  Random random(2);
  const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
  EXPECT_EQ(Moved(X_CM, Vector6d::Zero()).matrix(), X_CM.matrix());
  const Eigen::Matrix3d R = Moved(X_CM, RandomStep(&random, 1)).linear();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_GT(R.determinant(), 0);
}

// One measurement's H is w J J^T and its g is w J r, J the derivative of slope . p_C(step).
TEST(PoseEquationsTest, JEqualsFiniteDifferencesOfTheSlope) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
    const Vector3d slope = RandomVector(&random), p_M = 0.1 * RandomVector(&random);
    Vector6d J;
    for (int k = 0; k < 6; ++k) {
      const Vector6d step = 1e-5 * Vector6d::Unit(k);
      J[k] = slope.dot(Moved(X_CM, step) * p_M - Moved(X_CM, -step) * p_M) / 2e-5;
    }
    PoseEquations equations;
    const Vector3d arm = X_CM.linear() * p_M;
    equations.Add(slope.cast<float>(), arm.cast<float>(), 0.7f, 2.5f);
    EXPECT_LT((equations.Full() - 2.5 * J * J.transpose()).norm(), 1e-5);
    EXPECT_LT((equations.g - 2.5 * 0.7 * J).norm(), 1e-5);
  }
}

TEST(PoseEquationsTest, MeasurementsAddUp) {
  Random random(4);
  PoseEquations both, first, second;
  const Vector3f a = RandomVector(&random).cast<float>(), b = RandomVector(&random).cast<float>();
  both.Add(a, b, 1, 2);
  both.Add(b, a, -3, 0.5f);
  first.Add(a, b, 1, 2);
  second.Add(b, a, -3, 0.5f);
  EXPECT_LT((both.Full() - first.Full() - second.Full()).norm(), 1e-6);
  EXPECT_LT((both.g - first.g - second.g).norm(), 1e-6);
}

TEST(PoseEquationsTest, FullIsSymmetric) {
  Random random(5);
  PoseEquations equations;
  for (int i = 0; i < 9; ++i) {
    equations.Add(RandomVector(&random).cast<float>(), RandomVector(&random).cast<float>(), 1, 1);
  }
  const Matrix6d full = equations.Full();
  EXPECT_EQ(full, full.transpose());
  EXPECT_GT(full.llt().info() == Eigen::Success, 0);
}

TEST(PoseEquationsTest, SolvingThemFindsTheStepThatWasMeasured) {
  Random random(6);
  const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
  const Vector6d truth = RandomStep(&random, 0.003);
  PoseEquations equations;
  for (int i = 0; i < 60; ++i) {
    const Vector3d p_M = 0.1 * RandomVector(&random), slope = 800 * RandomVector(&random);
    const double moved = slope.dot(Moved(X_CM, truth) * p_M - X_CM * p_M);
    equations.Add(slope.cast<float>(), (X_CM.linear() * p_M).cast<float>(),
                  static_cast<float>(moved), 1);
  }
  const Vector6d step = equations.Full().ldlt().solve(equations.g);
  EXPECT_LT((step - truth).norm(), 0.01 * truth.norm());
}

TEST(PoseEquationsTest, APriorAddsInverseVariancesAndPullsNowhere) {
  PoseEquations equations;
  equations.AddPrior(0.02, 0.1);
  const Matrix6d full = equations.Full();
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(full(k, k), 2500, 1e-9);
    EXPECT_NEAR(full(k + 3, k + 3), 100, 1e-9);
  }
  EXPECT_EQ((full - Matrix6d(full.diagonal().asDiagonal())).norm(), 0);
  EXPECT_EQ(equations.g, Vector6d::Zero());
}

}  // namespace
}  // namespace visavis
