#include "services/recogniser/refined/pose_covariance.h"

#include <gtest/gtest.h>

#include "common/core/random.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

const Vector3d kStraight(0, 0, -1);

Vector3d Turned(double rad) { return {std::sin(rad), 0, -std::cos(rad)}; }

/// Of about 1 mm and 0.3 deg.
Matrix6d Information() {
  Vector6d weights;
  weights << 1e6, 1e6, 3e5, 4e4, 4e4, 9e4;
  return weights.asDiagonal();
}

double SigmaMm(const Matrix6d& covariance, int axis) {
  return 1e3 * std::sqrt(covariance(axis, axis));
}

TEST(PoseCovarianceTest, AnyFaceHasTheEquationsInverseAndWhatAShapeLeavesOpen) {
  const Matrix6d inverse = Information().inverse();
  const Matrix6d rest = PoseCovariance::OfAnyFace(Information()) - inverse;
  EXPECT_NEAR(1e3 * std::sqrt(rest(0, 0)), 0.6, 1e-6);
  EXPECT_NEAR(1e3 * std::sqrt(rest(5, 5)), 9, 1e-6);
  EXPECT_NEAR(rest(0, 5), 0, 1e-15);
}

TEST(PoseCovarianceTest, BeforeAnythingIsLearnedALearnedFaceIsAnyFace) {
  const PoseCovariance nothing;
  EXPECT_EQ(nothing.OfLearnedFace(Information(), kStraight),
            PoseCovariance::OfAnyFace(Information()));
}

TEST(PoseCovarianceTest, ALearnedFaceIsSurerTheLongerItIsLearned) {
  PoseCovariance covariance;
  double last = SigmaMm(PoseCovariance::OfAnyFace(Information()), 2);
  for (int k = 0; k < 5; ++k) {
    for (int i = 0; i < 10; ++i) covariance.Learn(kStraight);
    const double now = SigmaMm(covariance.OfLearnedFace(Information(), kStraight), 2);
    EXPECT_LT(now, last);
    last = now;
  }
}

TEST(PoseCovarianceTest, FarFromTheLearnedViewsTheAnglesAreVague) {
  PoseCovariance covariance;
  for (int i = 0; i < 100; ++i) covariance.Learn(kStraight);
  const auto sigma_rad = [&](double turned) {
    return 1e-3 * SigmaMm(covariance.OfLearnedFace(Information(), Turned(turned)), 4);
  };
  EXPECT_LT(sigma_rad(0.3), 1.1 * sigma_rad(0));
  EXPECT_GT(sigma_rad(0.9), 5 * sigma_rad(0));
}

TEST(PoseCovarianceTest, ItIsLessSureTheFartherTheViewHasTurnedFromTheMeanOfThoseLearned) {
  PoseCovariance covariance;
  for (int i = 0; i < 100; ++i) covariance.Learn(Turned(i % 2 == 0 ? 0.1 : 0.3));
  double last = 0;
  for (const double turned : {0.0, 0.1, 0.2, 0.4}) {
    const double now = SigmaMm(covariance.OfLearnedFace(Information(), Turned(0.2 + turned)), 0);
    EXPECT_GT(now, last) << turned;
    last = now;
    const double mirrored =
        SigmaMm(covariance.OfLearnedFace(Information(), Turned(0.2 - turned)), 0);
    EXPECT_NEAR(mirrored, now, 1e-6) << turned;
  }
}

TEST(PoseCovarianceTest, AnotherFaceBeginsAnew) {
  PoseCovariance covariance;
  for (int i = 0; i < 100; ++i) covariance.Learn(kStraight);
  covariance.Forget();
  EXPECT_EQ(covariance.OfLearnedFace(Information(), kStraight),
            PoseCovariance::OfAnyFace(Information()));
}

// Position of R: p + w x r for a small turn w.
TEST(PoseCovarianceTest, AHiddenFaceIsLessSureMostOfAllAlongTheLineOfSight) {
  const Matrix6d free = PoseCovariance::OfAnyFace(Information());
  EXPECT_EQ(WithHidden(free, 0, {0, 0, 1}), free);
  const Matrix6d more = WithHidden(free, 0.5, {0, 0.6, 0.8}) - free;
  const Vector3d along(0, 0.6, 0.8), across(0, 0.8, -0.6);
  const Eigen::Matrix3d place = more.topLeftCorner<3, 3>();
  EXPECT_NEAR(1e3 * std::sqrt(along.dot(place * along)), std::hypot(5.0, 1.0), 1e-6);
  EXPECT_NEAR(1e3 * std::sqrt(across.dot(place * across)), 1, 1e-6);
  EXPECT_NEAR(1e3 * std::sqrt(more(4, 4)), 15, 1e-6);
}

TEST(PoseCovarianceTest, ALeverTurnsRotationIntoPosition) {
  Random random(2);
  Matrix6d root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = random.Normal();
  const Matrix6d covariance = root * root.transpose();
  const Vector3d r(0.3, -0.2, 0.5);
  Matrix6d lever = Matrix6d::Identity();
  for (int k = 0; k < 3; ++k) lever.block<3, 1>(0, 3 + k) = Vector3d::Unit(k).cross(r);
  EXPECT_TRUE(WithLever(covariance, r).isApprox(lever * covariance * lever.transpose(), 1e-12));
  EXPECT_TRUE(WithLever(covariance, Vector3d::Zero()).isApprox(covariance, 1e-15));
}

}  // namespace
}  // namespace visavis
