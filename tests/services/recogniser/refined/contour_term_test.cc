#include "services/recogniser/refined/contour_term.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

class ContourTermTest : public ::testing::Test {
 protected:
  ContourTermTest()
      : scene_(TestRig()),
        term_(SharedAdultHead().mesh, HairlineOf(SharedAdultHead().surface, 33)),
        X_CM_(TransformFromPhi(PhiOf(20, -10, 1000, 4, -5, 3))),
        view_(scene_.Show(X_CM_, FlatHead)) {}

  PoseEquations Equations(const RigidTransform& X_CM, int reach, float outline, float hairline) {
    PoseEquations equations;
    fit_ = {};
    for (const EyeView& eye : view_) {
      term_.Add(eye, EyePose(*eye.geometry, X_CM), reach, outline, hairline, &equations, &fit_);
    }
    return equations;
  }

  /// The step that both eyes' contours want at @p X_CM; a weak prior holds what they do not see.
  Vector6d StepAt(const RigidTransform& X_CM, float hairline = 0.15f) {
    PoseEquations equations = Equations(X_CM, 9, 1, hairline);
    equations.AddPrior(0.025, 0.2);
    return equations.Full().ldlt().solve(equations.g);
  }

  MeshScene scene_;
  ContourTerm term_;
  RigidTransform X_CM_;
  const StereoView& view_;
  ContourFit fit_;
};

TEST_F(ContourTermTest, AtTheTruePoseTheStepIsNearZero) {
  const Vector6d step = StepAt(X_CM_);
  EXPECT_LT(step.head<2>().norm(), 0.0005);
  EXPECT_LT(std::abs(step[2]), 0.002);
  EXPECT_LT(std::abs(step[3]), 0.01);
  EXPECT_GT(fit_.count, 80);
  EXPECT_LT(std::sqrt(fit_.sum_square / fit_.count), 0.8);  // px
}

// 3 mm are 2.4 px.
TEST_F(ContourTermTest, AHeadDisplacedAsideIsPulledBackByAsMuch) {
  for (int k = 0; k < 2; ++k) {
    for (const double error : {-0.003, 0.003}) {
      const Vector6d step = StepAt(Moved(X_CM_, error * Vector6d::Unit(k)));
      EXPECT_NEAR(step[k], -error, 0.2 * std::abs(error)) << k;
      EXPECT_NEAR(step[1 - k], 0, 0.0006) << k;
      EXPECT_GT(std::sqrt(fit_.sum_square / fit_.count), 1.2);
    }
  }
}

TEST_F(ContourTermTest, AHeadDisplacedInDepthIsPulledBackByAsMuch) {
  for (const double error : {-0.012, 0.012}) {
    EXPECT_NEAR(StepAt(Moved(X_CM_, error * Vector6d::Unit(2)))[2], -error, 0.0024);
  }
}

// 50 mrad move the crown and the chin by about 4 px.
TEST_F(ContourTermTest, AHeadTurnedAboutTheOpticalAxisIsTurnedBackByAsMuch) {
  for (const double error : {-0.05, 0.05}) {
    EXPECT_NEAR(StepAt(Moved(X_CM_, error * Vector6d::Unit(3)))[3], -error, 0.01);
  }
}

TEST_F(ContourTermTest, OneEyeAloneSeesTheDisplacementAside) {
  for (std::size_t e = 0; e < 2; ++e) {
    const RigidTransform X = Moved(X_CM_, 0.003 * Vector6d::Unit(0));
    PoseEquations equations;
    ContourFit fit;
    term_.Add(view_[e], EyePose(*view_[e].geometry, X), 9, 1, 0.15f, &equations, &fit);
    equations.AddPrior(0.025, 0.2);
    const Vector6d step = equations.Full().ldlt().solve(equations.g);
    EXPECT_NEAR(step[0], -0.003, 0.0006) << e;
  }
}

TEST_F(ContourTermTest, TheHairlineAddsToTheEquationsNotToTheFitOfTheOutline) {
  const PoseEquations without = Equations(X_CM_, 7, 0, 0);
  const ContourFit fit = fit_;
  const PoseEquations with = Equations(X_CM_, 7, 0, 1);
  EXPECT_EQ(without.H, Matrix6d::Zero());
  EXPECT_GT(with.H.norm(), 0);
  EXPECT_EQ(fit_.count, fit.count);
  EXPECT_EQ(fit_.sum_square, fit.sum_square);
}

TEST_F(ContourTermTest, TheHairlinePullsAPitchedHeadBack) {
  for (const double error : {-0.05, 0.05}) {
    // Nodding moves the hairline up or down while the outline stays about where it is.
    const RigidTransform X =
        MakeTransform((X_CM_.linear() * ExpRotation({error, 0, 0})).eval(), X_CM_.translation());
    const Eigen::Vector3d axis = X.linear().col(0);
    const PoseEquations equations = Equations(X, 7, 0, 1);
    const double turn_g = axis.dot(equations.g.tail<3>());
    const double turn_H = axis.dot(equations.Full().bottomRightCorner<3, 3>() * axis);
    EXPECT_NEAR(turn_g / turn_H, -error, 0.4 * std::abs(error));
  }
}

TEST_F(ContourTermTest, WeightsScaleTheEquations) {
  const RigidTransform X = Moved(X_CM_, 0.003 * Vector6d::Unit(0));
  const PoseEquations once = Equations(X, 7, 1, 0), thrice = Equations(X, 7, 3, 0);
  EXPECT_LT((thrice.H - 3 * once.H).norm(), 1e-4 * thrice.H.norm());
  EXPECT_LT((thrice.g - 3 * once.g).norm(), 1e-4 * thrice.g.norm());
}

TEST_F(ContourTermTest, AReachBeyondTheLimitIsClamped) {
  const PoseEquations most = Equations(X_CM_, 16, 1, 0.15f),
                      beyond = Equations(X_CM_, 99, 1, 0.15f);
  EXPECT_EQ(most.H, beyond.H);
  EXPECT_EQ(most.g, beyond.g);
}

TEST_F(ContourTermTest, HeadsOutOfSightSayNothing) {
  EXPECT_EQ(Equations(TransformFromPhi(PhiOf(2000, 0, 1000, 0, 0, 0)), 9, 1, 1).H,
            Matrix6d::Zero());
  EXPECT_EQ(Equations(TransformFromPhi(PhiOf(0, 0, -1000, 0, 0, 0)), 9, 1, 1).H, Matrix6d::Zero());
  EXPECT_EQ(fit_.count, 0);
}

TEST_F(ContourTermTest, GreyLevelsHaveContoursToo) {
  scene_.ShowGray(X_CM_, FlatHead);
  const Vector6d aside = StepAt(Moved(X_CM_, PhiOf(3, 0, 0, 0, 0, 0)));
  EXPECT_GT(fit_.count, 20);
  EXPECT_NEAR(1e3 * aside[0], -3, 1.5);
}

TEST_F(ContourTermTest, OnAnEmptyWallEveryContourIsFarOff) {
  // The colours are known from a head that is painted elsewhere.
  scene_.Show(TransformFromPhi(PhiOf(-250, 0, 1000, 0, 0, 0)), FlatHead);
  const PoseEquations equations =
      Equations(TransformFromPhi(PhiOf(150, 0, 1000, 0, 0, 0)), 6, 1, 0);
  EXPECT_GT(fit_.count, 40);
  EXPECT_GT(std::sqrt(fit_.sum_square / fit_.count), 4.0);
  EXPECT_LE(fit_.sum_square, 25.0 * fit_.count);
  EXPECT_TRUE(equations.g.allFinite());
}

}  // namespace
}  // namespace visavis
