#include "services/recogniser/refined/head_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr double kMaxStep_m = 0.002, kMaxStep_rad = 0.01;

/// A direction @p angle [rad] aside of straight ahead.
Vector3d Direction(double angle) { return {std::sin(angle), 0, -std::cos(angle)}; }

Vector6d Step(double x, double y, double z, double a, double b, double c) {
  return (Vector6d() << x, y, z, a, b, c).finished();
}

/// Equations that @p step solves, with some directions better known than others.
PoseEquations EquationsOf(const Vector6d& step, double weight = 1) {
  PoseEquations equations;
  Vector6d diagonal = Step(4e4, 3e4, 1e3, 900, 500, 700);
  Vector6d v = Step(100, -60, 20, 8, -5, 3);
  equations.H = weight * (Matrix6d(diagonal.asDiagonal()) + v * v.transpose());
  equations.g = equations.H * step;
  return equations;
}

Vector6d StepOf(const RigidTransform& X_MN) {
  Vector6d step;
  step << X_MN.translation(), LogRotation(X_MN.linear());
  return step;
}

const Vector6d kSmall = Step(0.0008, -0.0005, 0.001, 0.003, -0.002, 0.004);

TEST(HeadAnchorTest, WithoutViewsNothingIsCorrected) {
  HeadAnchor anchor;
  EXPECT_EQ(anchor.views(), 0);
  EXPECT_TRUE(anchor.Correct().isApprox(RigidTransform::Identity()));
}

TEST(HeadAnchorTest, OneViewIsFollowed) {
  HeadAnchor anchor;
  anchor.Add(Direction(0), EquationsOf(kSmall));
  EXPECT_LT((StepOf(anchor.Correct()) - kSmall).norm(), 1e-9);
}

TEST(HeadAnchorTest, TheCorrectionSolvesTheBundledEquations) {
  HeadAnchor anchor;
  Random random(1);
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  for (int i = 0; i < 8; ++i) {
    PoseEquations view = EquationsOf(kSmall, 1 + i);
    for (int k = 0; k < 6; ++k) view.g[k] *= random.Uniform(0.5, 1.5);
    anchor.Add(Direction(0.1 * i), view);
    H += view.H;
    g += view.g;
  }
  EXPECT_EQ(anchor.views(), 8);
  const Vector6d step = StepOf(anchor.Correct());
  ASSERT_LT(step.head<3>().norm(), kMaxStep_m);
  ASSERT_LT(step.tail<3>().norm(), kMaxStep_rad);
  EXPECT_LT((H * step - g).norm(), 1e-6 * g.norm());
}

TEST(HeadAnchorTest, EqualViewsCountOnce) {
  HeadAnchor anchor;
  for (int i = 0; i < 20; ++i) anchor.Add(Direction(0.001 * i), EquationsOf(kSmall));
  EXPECT_EQ(anchor.views(), 1);
  anchor.Add(Direction(0.5), EquationsOf(-kSmall));
  EXPECT_EQ(anchor.views(), 2);
  // Twenty of one kind against one of the other: each one half.
  EXPECT_LT(StepOf(anchor.Correct()).norm(), 1e-9);
}

TEST(HeadAnchorTest, ViewsAreDistinctFromSixHundredthsOfARadian) {
  HeadAnchor anchor;
  anchor.Add(Direction(0), EquationsOf(kSmall));
  anchor.Add(Direction(0.055), EquationsOf(kSmall));
  EXPECT_EQ(anchor.views(), 1);
  anchor.Add(Direction(0.065), EquationsOf(kSmall));
  EXPECT_EQ(anchor.views(), 2);
}

TEST(HeadAnchorTest, FramesOfOneViewAreAveraged) {
  HeadAnchor anchor;
  for (const double factor : {0.0, 1.0, 2.0})
    anchor.Add(Direction(0), EquationsOf(factor * kSmall));
  EXPECT_LT((StepOf(anchor.Correct()) - kSmall).norm(), 1e-9);
}

TEST(HeadAnchorTest, AViewForgetsFramesLongPast) {
  HeadAnchor anchor;
  for (int i = 0; i < 50; ++i) anchor.Add(Direction(0), EquationsOf(-kSmall));
  for (int i = 0; i < 200; ++i) anchor.Add(Direction(0), EquationsOf(kSmall));
  EXPECT_LT((StepOf(anchor.Correct()) - kSmall).norm(), 0.01 * kSmall.norm());
}

TEST(HeadAnchorTest, AfterACorrectionTheSameViewsWantNoOther) {
  HeadAnchor anchor;
  anchor.Add(Direction(0), EquationsOf(kSmall));
  anchor.Add(Direction(0.3), EquationsOf(0.5 * kSmall, 3));
  EXPECT_GT(StepOf(anchor.Correct()).norm(), 1e-4);
  EXPECT_LT(StepOf(anchor.Correct()).norm(), 1e-9);
}

TEST(HeadAnchorTest, OneFrameMovesTheFrameByNoMoreThanTheLimitAndAlongTheWayWanted) {
  HeadAnchor anchor;
  const Vector6d wanted = Step(0.010, 0, 0.004, 0, 0.08, -0.03);
  anchor.Add(Direction(0), EquationsOf(wanted));
  const Vector6d step = StepOf(anchor.Correct());
  EXPECT_NEAR(step.head<3>().norm(), kMaxStep_m, 1e-9);
  EXPECT_NEAR(step.tail<3>().norm(), kMaxStep_rad, 1e-9);
  EXPECT_LT(step.head<3>().cross(wanted.head<3>()).norm(), 1e-9);
  EXPECT_GT(step.head<3>().dot(wanted.head<3>()), 0);
}

TEST(HeadAnchorTest, ALargeCorrectionIsMadeInManySmallOnes) {
  HeadAnchor anchor;
  const Vector6d wanted = Step(0.010, 0, 0.004, 0, 0.08, -0.03);
  anchor.Add(Direction(0), EquationsOf(wanted));
  Vector6d sum = Vector6d::Zero();
  for (int i = 0; i < 60; ++i) sum += StepOf(anchor.Correct());
  EXPECT_LT((sum - wanted).norm(), 1e-6);
}

TEST(HeadAnchorTest, ForgetLeavesNoViews) {
  HeadAnchor anchor;
  anchor.Add(Direction(0), EquationsOf(kSmall));
  anchor.Forget();
  EXPECT_EQ(anchor.views(), 0);
  EXPECT_TRUE(anchor.Correct().isApprox(RigidTransform::Identity()));
  anchor.Add(Direction(0), EquationsOf(-kSmall));
  EXPECT_LT((StepOf(anchor.Correct()) + kSmall).norm(), 1e-9);
}

TEST(HeadAnchorTest, EquationsThatAreNotNumbersMoveNothing) {
  HeadAnchor anchor;
  PoseEquations bad = EquationsOf(kSmall);
  bad.g[2] = NAN;
  anchor.Add(Direction(0), bad);
  EXPECT_EQ(anchor.Correct().matrix(), RigidTransform::Identity().matrix());
}

TEST(HeadAnchorTest, TheNumberOfViewsIsBounded) {
  HeadAnchor anchor;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 20; ++j) {
      const double azimuth = 0.1 * i, height = -0.9 + 0.1 * j;
      const Vector3d d(std::sin(azimuth), height, -std::cos(azimuth));
      anchor.Add(d.normalized(), EquationsOf(kSmall));
    }
  }
  EXPECT_EQ(anchor.views(), 200);
  EXPECT_LT((StepOf(anchor.Correct()) - kSmall).norm(), 1e-9);
}

}  // namespace
}  // namespace visavis
