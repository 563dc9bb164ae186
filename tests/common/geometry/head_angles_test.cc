#include "common/geometry/head_angles.h"

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace visavis {
namespace {

Eigen::Vector3d RandomAngles(Random* random) {
  return {random->Uniform(-3, 3), random->Uniform(-1.5, 1.5), random->Uniform(-3, 3)};
}

TEST(HeadAnglesTest, RotationIsRzTimesRyTimesRx) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d a = RandomAngles(&random);
    const Eigen::Matrix3d expected = (Eigen::AngleAxisd(a[0], Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(a[1], Eigen::Vector3d::UnitY()) *
                                      Eigen::AngleAxisd(a[2], Eigen::Vector3d::UnitX()))
                                         .toRotationMatrix();
    EXPECT_LT((RotationFromAngles(a) - expected).norm(), 1e-14);
  }
}

TEST(HeadAnglesTest, Eq35RebuildsTheRotation) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d a = RandomAngles(&random);
    EXPECT_LT((AnglesFromRotation(RotationFromAngles(a)) - a).norm(), 1e-12);
  }
}

// Eq. 7: R' = [w x] R (Eq. 13), so w follows from a finite difference of R along the angle rates.
TEST(HeadAnglesTest, JcMatchesFiniteDifferences) {
  Random random(3);
  const double h = 1e-6;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d a = RandomAngles(&random);
    const Eigen::Vector3d rate(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1));
    const Eigen::Matrix3d dR =
        (RotationFromAngles(a + h * rate) - RotationFromAngles(a - h * rate)) / (2 * h);
    const Eigen::Matrix3d w_cross = dR * RotationFromAngles(a).transpose();
    const Eigen::Vector3d w(w_cross(2, 1), w_cross(0, 2), w_cross(1, 0));
    EXPECT_LT((AngularVelocityFromAngleRates(a) * rate - w).norm(), 1e-8);
    EXPECT_LT((AngleRatesFromAngularVelocity(a) * w - rate).norm(), 1e-6 / std::cos(a[1]));
  }
}

TEST(HeadAnglesTest, JcRefusesGimbalLock) {
  EXPECT_THROW(AngleRatesFromAngularVelocity({0.1, M_PI / 2, 0.2}), std::domain_error);
}

TEST(HeadAnglesTest, ErrorIsZeroForEqualPosesAndKnownOtherwise) {
  Vector6d phi;
  phi << 0.1, -0.05, 1.0, 0.1, -0.2, 0.3;
  const RigidTransform truth = TransformFromPhi(phi);
  EXPECT_LT(ComputeRecognitionError(truth, truth).Stacked().norm(), 1e-12);

  // The estimate is turned by d about M's own axes, so Eqs. 33 and 34 give d back.
  const Eigen::Vector3d d(0.01, -0.02, 0.03);
  RigidTransform estimate = truth;
  estimate.linear() = truth.linear() * RotationFromAngles(d);
  estimate.translation() -= Eigen::Vector3d(0.001, 0.002, 0.003);
  const RecognitionError error = ComputeRecognitionError(truth, estimate);
  EXPECT_LT((error.angles - d).norm(), 1e-12);
  EXPECT_LT((error.position - Eigen::Vector3d(0.001, 0.002, 0.003)).norm(), 1e-12);
  EXPECT_NEAR(error.total_angle, LogRotation(RotationFromAngles(d)).norm(), 1e-12);
}

TEST(HeadAnglesTest, PhiAndTransformAreInverse) {
  Vector6d phi;
  phi << 0.1, -0.05, 1.0, 0.1, -0.2, 0.3;
  EXPECT_LT((PhiFromTransform(TransformFromPhi(phi)) - phi).norm(), 1e-12);
}

}  // namespace
}  // namespace visavis
