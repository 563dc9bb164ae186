#include "common/geometry/rigid_transform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"

namespace visavis {
namespace {

constexpr double kEpsilon = 1e-15;

Eigen::Vector3d RandomVector(Random* random, double length) {
  Eigen::Vector3d v;
  do {
    v = {random->Uniform(-1, 1), random->Uniform(-1, 1), random->Uniform(-1, 1)};
  } while (v.norm() < 0.1);
  return length * v.normalized();
}

// The exponential map by its definition: the power series of the matrix [r x].
Eigen::Matrix3d SeriesExp(const Eigen::Vector3d& r) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity(), term = sum;
  for (int k = 1; k < 60; ++k) {
    term = (term * Skew(r) / k).eval();
    sum += term;
  }
  return sum;
}

TEST(RigidTransformTest, TransformsPointsByDefinition) {
  const Eigen::Matrix3d R_AB = SeriesExp({0.1, -0.4, 0.7});
  const Eigen::Vector3d p_AB(1, 2, 3), p_B(-0.5, 0.25, 4);
  EXPECT_LT((MakeTransform(R_AB, p_AB) * p_B - (R_AB * p_B + p_AB)).norm(), 10 * kEpsilon);
}

TEST(RigidTransformTest, AQuaternionOfAnotherNormTurnsAsMuch) {
  const Eigen::Quaterniond q(0.9, 0.1, -0.3, 0.2);
  const Eigen::Quaterniond scaled(1.8, 0.2, -0.6, 0.4);
  const auto X = MakeTransform(q, {0, 0, 0}), Y = MakeTransform(scaled, {0, 0, 0});
  EXPECT_LT((X.matrix() - Y.matrix()).norm(), 10 * kEpsilon);
  EXPECT_LT((X.linear() * X.linear().transpose() - Eigen::Matrix3d::Identity()).norm(),
            10 * kEpsilon);
}

TEST(RigidTransformTest, SkewIsTheCrossProduct) {
  const Eigen::Vector3d v(1, -2, 3), u(0.3, 0.5, -0.7);
  EXPECT_EQ(Skew(v) * u, v.cross(u));
}

TEST(RigidTransformTest, QAndMinusQGiveTheSameCanonicalNumbers) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d R = SeriesExp(RandomVector(&random, random.Uniform(0, 3.1)));
    const Eigen::Quaterniond q = CanonicalQuaternion(R);
    EXPECT_GE(q.w(), 0);
    EXPECT_NEAR(q.norm(), 1, 10 * kEpsilon);
    EXPECT_LT((q.toRotationMatrix() - R).norm(), 100 * kEpsilon);
  }
}

TEST(RotationVectorTest, ExpIsThePowerSeries) {
  Random random(2);
  for (const double angle : {1e-12, 1e-8, 1e-4, 0.01, 1.0, 3.0, 3.14159, 6.0}) {
    const Eigen::Vector3d r = RandomVector(&random, angle);
    EXPECT_LT((ExpRotation(r) - SeriesExp(r)).norm(), 1e-12) << angle;
  }
}

TEST(RotationVectorTest, ExpAndLogAreExactAtZero) {
  EXPECT_EQ(ExpRotation({0, 0, 0}), Eigen::Matrix3d::Identity());
  EXPECT_EQ(LogRotation(Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero());
}

TEST(RotationVectorTest, LogInvertsExpWithFullRelativePrecisionNearZero) {
  Random random(3);
  for (const double angle : {1e-14, 1e-10, 1e-6, 1e-3}) {
    const Eigen::Vector3d r = RandomVector(&random, angle);
    EXPECT_LT((LogRotation(ExpRotation(r)) - r).norm(), 1e-9 * angle) << angle;
  }
}

TEST(RotationVectorTest, LogInvertsExpUpToPi) {
  Random random(4);
  for (const double angle : {0.5, 2.0, 3.0, M_PI - 1e-3, M_PI - 1e-6, M_PI - 1e-9}) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d r = RandomVector(&random, angle);
      EXPECT_LT((LogRotation(ExpRotation(r)) - r).norm(), 1e-8) << angle;
    }
  }
}

// At pi the axis has two signs; either one gives the rotation back.
TEST(RotationVectorTest, LogAtPiRebuildsTheRotation) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix3d R = ExpRotation(RandomVector(&random, M_PI));
    const Eigen::Vector3d r = LogRotation(R);
    EXPECT_NEAR(r.norm(), M_PI, 1e-9);
    EXPECT_LT((ExpRotation(r) - R).norm(), 1e-8);
  }
  for (int axis = 0; axis < 3; ++axis) {
    Eigen::Vector3d diagonal = Eigen::Vector3d::Constant(-1);
    diagonal[axis] = 1;
    const Eigen::Vector3d r = LogRotation(diagonal.asDiagonal());
    EXPECT_NEAR(std::abs(r[axis]), M_PI, 1e-12);
  }
}

TEST(RotationVectorTest, TurningFurtherThanPiGivesTheShorterWayBack) {
  const Eigen::Vector3d r(0, 0, 4);
  EXPECT_LT((LogRotation(ExpRotation(r)) - Eigen::Vector3d(0, 0, 4 - 2 * M_PI)).norm(), 1e-12);
}

class InterpolateTest : public ::testing::Test {
 protected:
  RigidTransform Pose(Random* random) {
    return MakeTransform(ExpRotation(RandomVector(random, random->Uniform(0, 3))),
                         RandomVector(random, 2));
  }
  Random random_{6};
};

TEST_F(InterpolateTest, IsEachPoseAtItsEnd) {
  for (int i = 0; i < 50; ++i) {
    const auto X_0 = Pose(&random_), X_1 = Pose(&random_);
    EXPECT_LT((Interpolate(X_0, X_1, 0).matrix() - X_0.matrix()).norm(), 1e-14);
    EXPECT_LT((Interpolate(X_0, X_1, 1).matrix() - X_1.matrix()).norm(), 1e-12);
  }
}

TEST_F(InterpolateTest, TurnsAtAConstantRateOnTheShortestArc) {
  for (int i = 0; i < 50; ++i) {
    const auto X_0 = Pose(&random_), X_1 = Pose(&random_);
    const auto angle_to = [&](double s) {
      return LogRotation(X_0.linear().transpose() * Interpolate(X_0, X_1, s).linear()).norm();
    };
    const double whole = angle_to(1);
    EXPECT_LE(whole, M_PI);
    EXPECT_NEAR(angle_to(0.25), 0.25 * whole, 1e-9);
    EXPECT_NEAR(angle_to(0.75), 0.75 * whole, 1e-9);
  }
}

TEST_F(InterpolateTest, MovesOnAStraightLineAndBeyondItsEnds) {
  const auto X_0 = Pose(&random_), X_1 = Pose(&random_);
  const Eigen::Vector3d step = X_1.translation() - X_0.translation();
  for (const double s : {-0.5, 0.3, 1.5}) {
    const Eigen::Vector3d expected = X_0.translation() + s * step;
    EXPECT_LT((Interpolate(X_0, X_1, s).translation() - expected).norm(), 1e-14) << s;
  }
}

TEST_F(InterpolateTest, ExtrapolatesTheRotationToo) {
  const auto X_0 = MakeTransform(ExpRotation({0, 0, 0.1}), {0, 0, 0});
  const auto X_1 = MakeTransform(ExpRotation({0, 0, 0.3}), {0, 0, 0});
  EXPECT_LT((LogRotation(Interpolate(X_0, X_1, 2).linear()) - Eigen::Vector3d(0, 0, 0.5)).norm(),
            1e-12);
}

TEST_F(InterpolateTest, EqualPosesStayWhereTheyAre) {
  const auto X = Pose(&random_);
  EXPECT_LT((Interpolate(X, X, 0.7).matrix() - X.matrix()).norm(), 1e-12);
}

}  // namespace
}  // namespace visavis
