#include "services/recogniser/refined/mesh_fitness.h"

#include <gtest/gtest.h>

#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

const Vector6d kTruth = PhiOf(20, -10, 1000, 4, -5, 3);

class MeshFitnessTest : public ::testing::Test {
 protected:
  MeshFitnessTest()
      : scene_(TestRig()),
        fitness_(SharedAdultHead().mesh, SharedAdultHead().face, 1),
        view_(scene_.Show(TransformFromPhi(kTruth), FeaturedHead)) {}

  MeshScore ScoreAside(const Vector6d& aside) const {
    return fitness_.Evaluate(view_, TransformFromPhi(kTruth + aside));
  }

  MeshScene scene_;
  MeshFitness fitness_;
  const StereoView& view_;
};

/// 15 mm aside, 60 mm in depth and 8 deg about each axis, both ways.
std::vector<Vector6d> Displacements() {
  std::vector<Vector6d> all;
  for (const double sign : {-1.0, 1.0}) {
    for (const Vector6d& aside :
         {PhiOf(15, 0, 0, 0, 0, 0), PhiOf(0, 15, 0, 0, 0, 0), PhiOf(0, 0, 60, 0, 0, 0),
          PhiOf(0, 0, 0, 8, 0, 0), PhiOf(0, 0, 0, 0, 8, 0), PhiOf(0, 0, 0, 0, 0, 8)}) {
      all.push_back(sign * aside);
    }
  }
  return all;
}

TEST_F(MeshFitnessTest, TheTruePoseBeatsDisplacedOnes) {
  const double truth = ScoreAside(Vector6d::Zero()).total();
  for (const Vector6d& aside : Displacements()) {
    EXPECT_LT(ScoreAside(aside).total(), truth - 0.1) << aside.transpose();
  }
}

TEST_F(MeshFitnessTest, BothEyesAgreeAtTheTrueDepthAlone) {
  const auto look = [&](double mm) {
    return fitness_.Look(view_, TransformFromPhi(kTruth + PhiOf(0, 0, mm, 0, 0, 0)));
  };
  EXPECT_GT(look(0).agreement, 0.9);
  for (const double mm : {-120.0, 120.0}) EXPECT_LT(look(mm).agreement, 0.6) << mm;
  EXPECT_EQ(look(0).found(), look(0).total() + MeshScore::kAgreementWeight * look(0).agreement);
  EXPECT_EQ(look(0).total(), ScoreAside(Vector6d::Zero()).total());
}

TEST_F(MeshFitnessTest, OneEyeHasNoneToAgreeWith) {
  StereoView one = view_;
  one[1].Close();
  EXPECT_EQ(fitness_.Look(one, TransformFromPhi(kTruth)).agreement, 0);
}

TEST_F(MeshFitnessTest, WhatIsWorthItIsFoundAsByLookingAndTheRestIsWorthLess) {
  for (const Vector6d& aside : Displacements()) {
    const RigidTransform X_CM = TransformFromPhi(kTruth + aside);
    const double found = fitness_.Look(view_, X_CM).found();
    EXPECT_NEAR(fitness_.FoundIfWorth(view_, X_CM, -10), found, 1e-9);
    EXPECT_LT(fitness_.FoundIfWorth(view_, X_CM, found + 0.5), found + 0.5);
  }
}

TEST_F(MeshFitnessTest, OneInThreePointsTellsTheSame) {
  const MeshFitness coarse(MeshOf(SharedAdultHead().surface, 3), SharedAdultHead().face, 3);
  const double truth = coarse.Evaluate(view_, TransformFromPhi(kTruth)).total();
  for (const Vector6d& aside : Displacements()) {
    EXPECT_LT(coarse.Evaluate(view_, TransformFromPhi(kTruth + aside)).total(), truth);
  }
}

TEST_F(MeshFitnessTest, AtTheTruePoseInsideIsAHeadAndOutsideIsNot) {
  const MeshScore score = ScoreAside(Vector6d::Zero());
  EXPECT_TRUE(score.has_ncc);
  EXPECT_GT(score.inside, 0.9);
  EXPECT_LT(score.outside, -0.9);
  EXPECT_GT(score.ncc, 0.6);
  EXPECT_LE(score.ncc, 1);
}

TEST_F(MeshFitnessTest, AsideTheInsideFallsAndTheOutsideRises) {
  const MeshScore truth = ScoreAside(Vector6d::Zero());
  for (const double x : {-30.0, 30.0}) {
    const MeshScore aside = ScoreAside(PhiOf(x, 0, 0, 0, 0, 0));
    EXPECT_LT(aside.inside, truth.inside - 0.3);
    EXPECT_GT(aside.outside, truth.outside + 0.3);
    EXPECT_LT(aside.ncc, truth.ncc - 0.3);
  }
}

TEST_F(MeshFitnessTest, OnTheWallNothingIsInside) {
  const MeshScore wall = ScoreAside(PhiOf(-300, 0, 0, 0, 0, 0));
  EXPECT_LT(wall.inside, -0.8);
  EXPECT_LT(std::abs(wall.ncc), 0.3);
  EXPECT_LT(wall.total(), ScoreAside(Vector6d::Zero()).total() - 1.5);
}

TEST_F(MeshFitnessTest, HairWhereSkinIsWantedAndSkinWhereHairIsCountAgainstThePose) {
  // Upside down and from behind much the same pixels are inside.
  const double truth = ScoreAside(Vector6d::Zero()).inside;
  EXPECT_LT(ScoreAside(PhiOf(0, 0, 0, 180, 0, 0)).inside, truth - 0.4);
  EXPECT_LT(ScoreAside(PhiOf(0, 0, 0, 0, 180, 0)).inside, truth - 0.4);
}

TEST_F(MeshFitnessTest, AFlatFaceHasTheColoursButNotThePattern) {
  const MeshScore featured = ScoreAside(Vector6d::Zero());
  scene_.Show(TransformFromPhi(kTruth), FlatHead);
  const MeshScore flat = ScoreAside(Vector6d::Zero());
  EXPECT_GT(flat.inside, 0.9);
  EXPECT_LT(flat.ncc, featured.ncc - 0.3);
}

TEST_F(MeshFitnessTest, AGrayPictureIsJudgedByItsLevelsAsByColours) {
  const MeshScore color = ScoreAside(Vector6d::Zero());
  scene_.ShowGray(TransformFromPhi(kTruth), FeaturedHead);
  const MeshScore gray = ScoreAside(Vector6d::Zero());
  EXPECT_TRUE(gray.has_ncc);
  EXPECT_NEAR(gray.ncc, color.ncc, 0.02);
  EXPECT_GT(gray.inside, 0.5);
  EXPECT_LT(gray.outside, -0.5);
  for (const double x : {-15.0, 15.0})
    EXPECT_LT(ScoreAside(PhiOf(x, 0, 0, 0, 0, 0)).total(), gray.total() - 0.2);
}

TEST_F(MeshFitnessTest, ScoresAreTheMeanOverTheEyesThatSee) {
  const StereoView both = view_;
  StereoView right = view_, left = view_, none = view_;
  for (StereoView* view : {&left, &none}) (*view)[0].Close();
  for (StereoView* view : {&right, &none}) (*view)[1].Close();
  const RigidTransform X_CM = TransformFromPhi(kTruth + PhiOf(5, 5, 0, 0, 0, 0));
  const MeshScore r = fitness_.Evaluate(right, X_CM), l = fitness_.Evaluate(left, X_CM);
  const MeshScore b = fitness_.Evaluate(both, X_CM), n = fitness_.Evaluate(none, X_CM);
  EXPECT_NE(r.inside, l.inside);
  EXPECT_NEAR(b.inside, 0.5 * (r.inside + l.inside), 1e-12);
  EXPECT_NEAR(b.outside, 0.5 * (r.outside + l.outside), 1e-12);
  EXPECT_NEAR(b.ncc, 0.5 * (r.ncc + l.ncc), 1e-12);
  EXPECT_FALSE(n.has_ncc);
  EXPECT_EQ(n.total(), 0);
}

TEST(MeshScoreTest, ColoursRoundTheHeadCountAgainstItDownToALimit) {
  MeshScore score;
  score.inside = 1;
  score.outside = 0.5;
  EXPECT_NEAR(score.total(), 0.25, 1e-12);
  score.outside = -1;
  const double least = score.total();
  score.outside = -1.25;
  EXPECT_EQ(score.total(), least);
}

TEST_F(MeshFitnessTest, EvaluatingAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  const RigidTransform X_CM = TransformFromPhi(kTruth);
  const std::int64_t before = NumMallocs();
  const double looked = fitness_.Look(view_, X_CM).found();
  const double found = fitness_.FoundIfWorth(view_, X_CM, 0);
  EXPECT_EQ(NumMallocs(), before);
  EXPECT_NEAR(found, looked, 1e-9);
}

}  // namespace
}  // namespace visavis
