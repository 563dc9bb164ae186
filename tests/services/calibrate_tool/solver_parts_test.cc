// What the solvers are made of, against plain twins.
#include <ceres/autodiff_cost_function.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"
#include "services/calibrate_tool/least_squares.h"
#include "services/calibrate_tool/planar_start.h"
#include "services/calibrate_tool/pose_block.h"
#include "services/calibrate_tool/projection.h"
#include "tests/support/board_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Eigen::Vector3d Vector(Random* random, double size) {
  return {random->Uniform(-size, size), random->Uniform(-size, size), random->Uniform(-size, size)};
}

TEST(ProjectionTest, IsThatOfPinhole) {
  Random random(1);
  const Pinhole camera = SkewedRig().right;
  const Intrinsics k = IntrinsicsOf(camera);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d p = Vector(&random, 0.4) + Eigen::Vector3d(0, 0, 1);
    EXPECT_LT((ProjectWith<double>(k.data(), p) - Project(camera, p).uv).norm(), 1e-9);
  }
  const Pinhole back = PinholeOf(k, camera.width, camera.height);
  EXPECT_EQ(back.distortion, camera.distortion);
  EXPECT_EQ(back.cy, camera.cy);
}

TEST(PoseBlockTest, AppliesThePoseAndItsInverse) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform X = MakeTransform(ExpRotation(Vector(&random, 2)), Vector(&random, 1));
    const PoseBlock block = BlockOf(X);
    const Eigen::Vector3d p = Vector(&random, 1);
    EXPECT_LT((Apply<double>(block.data(), p) - X * p).norm(), 1e-12);
    EXPECT_LT((ApplyInverse<double>(block.data(), p) - X.inverse() * p).norm(), 1e-12);
    EXPECT_LT((TransformOf(block).matrix() - X.matrix()).norm(), 1e-12);
  }
}

// exp(r + dr) = exp(r) exp(Jr dr) to first order.
TEST(PoseBlockTest, RightJacobianIsThatOfFiniteDifferences) {
  Random random(3);
  for (const double size : {1e-8, 0.01, 1.0, 1.7}) {
    const Eigen::Vector3d r = Vector(&random, size);
    for (int i = 0; i < 3; ++i) {
      const double h = 1e-6;
      const Eigen::Vector3d dr = h * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d turned =
          LogRotation(ExpRotation(r - dr).transpose() * ExpRotation(r + dr)) / (2 * h);
      EXPECT_LT((turned - RightJacobian(r).col(i)).norm(), 1e-7) << r.transpose();
    }
  }
}

/// y - (a + b x), with unit variance.
struct LineError {
  template <typename T>
  bool operator()(const T* a, const T* b, T* residual) const {
    residual[0] = y - (a[0] + b[0] * x);
    return true;
  }
  double x, y;
};

// Of a straight line through n points: var(b) = 1 / sum (x - mean)^2, var(a) = 1/n + mean^2 var(b).
TEST(LeastSquaresTest, CovarianceIsThatOfAStraightLine) {
  double a = 0, b = 0;
  ceres::Problem problem;
  for (const double x : {1.0, 2.0, 4.0, 7.0}) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LineError, 1, 1, 1>(new LineError{x, 3 - 2 * x}), nullptr,
        &a, &b);
  }
  SolveOrThrow("line", &problem);
  EXPECT_NEAR(a, 3, 1e-9);
  EXPECT_NEAR(b, -2, 1e-9);
  const Eigen::MatrixXd covariance = CovarianceOf("line", {&a, &b}, &problem);
  const double var_b = 1 / (2.5 * 2.5 + 1.5 * 1.5 + 0.5 * 0.5 + 3.5 * 3.5);
  EXPECT_NEAR(covariance(1, 1), var_b, 1e-12);
  EXPECT_NEAR(covariance(0, 0), 0.25 + 3.5 * 3.5 * var_b, 1e-12);
  EXPECT_NEAR(covariance(0, 1), -3.5 * var_b, 1e-12);
}

// a = mean(y) - b mean(x), where b is given.
TEST(LeastSquaresTest, SensitivityIsThatOfAStraightLineOfGivenSlope) {
  double a = 0, b = 0.5;
  ceres::Problem problem;
  for (const double x : {1.0, 2.0, 4.0, 7.0}) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LineError, 1, 1, 1>(new LineError{x, std::sin(x)}), nullptr,
        &a, &b);
  }
  problem.SetParameterBlockConstant(&b);
  SolveOrThrow("line", &problem);
  const Eigen::MatrixXd sensitivity = SensitivityOf("line", {&a}, {&b}, &problem);
  EXPECT_NEAR(sensitivity(0, 0), -3.5, 1e-12);
  EXPECT_TRUE(problem.IsParameterBlockConstant(&b));
}

TEST(LeastSquaresTest, WhatTheDataDoesNotDetermineIsRefused) {
  double a = 0, b = 0;
  ceres::Problem problem;
  for (int i = 0; i < 3; ++i) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<LineError, 1, 1, 1>(new LineError{2, 1}), nullptr, &a, &b);
  }
  EXPECT_THAT(
      [&] {
        CovarianceOf("line", {&a, &b}, &problem);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("line: the views do not determine")));
}

TEST(PlanarStartTest, PosesAreNearTheTruthAndLinesOfCornersHaveNone) {
  const BoardScene scene = MakeBoardScene(BoardSpec{}, 5, 1);
  const auto views = SeeAll(scene, 0, 1);
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto X_CT = StartPose(scene.board, views[i].view.right, scene.rig.right);
    ASSERT_TRUE(X_CT.has_value());
    EXPECT_LT((X_CT->translation() - scene.X_CT[i].translation()).norm(), 1e-3);
    EXPECT_LT(LogRotation(X_CT->linear().transpose() * scene.X_CT[i].linear()).norm(), 1e-3);
  }
  BoardView line;
  for (int i = 0; i < 10; ++i) {
    line.ids.push_back(i);
    line.pixels.emplace_back(100 + 40 * i, 200);
  }
  EXPECT_FALSE(StartPose(scene.board, line, scene.rig.right).has_value());
  EXPECT_FALSE(StartPose(scene.board, BoardView{}, scene.rig.right).has_value());
}

}  // namespace
}  // namespace visavis
