#include "services/simulator/head_shape.h"

#include <gtest/gtest.h>

#include "services/simulator/head_grid.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

/// Outermost skin from the middle of the head, in M [mm].
Vector3d SkinIn(const SkinSurface& surface, const Vector3d& origin, const Vector3d& direction) {
  return surface.ToM(surface.Outermost(origin, direction.normalized()));
}

class HeadShapeTest : public ::testing::TestWithParam<const char*> {
 protected:
  const Subject subject_ = NamedSubject(GetParam());
  const HeadMeasures& shape_ = subject_.shape;
  const SkinSurface surface_{shape_};
};
INSTANTIATE_TEST_SUITE_P(Subjects, HeadShapeTest,
                         ::testing::Values("adult_a", "adult_b", "adult_c", "adult_d", "adult_e",
                                           "adult_f", "adult_g", "adult_h"));

TEST_P(HeadShapeTest, CraniumIsCentredOnTheModelFramesOrigin) {
  const Vector3d axes = surface_.cranium_semi_axes_mm();
  EXPECT_NEAR(SkinIn(surface_, {0, 0, 0}, {0, -1, 0}).y(), -axes.y(), 1.5);
  EXPECT_NEAR(SkinIn(surface_, {0, 0, 0}, {0, 0, 1}).z(), axes.z(), 1.5);
  EXPECT_NEAR(SkinIn(surface_, {0, -10, 18}, {1, 0, 0}).x(), axes.x(), 2.0);
}

TEST_P(HeadShapeTest, BreadthLengthAndHeightAreThoseAskedFor) {
  double widest = 0, back = 0, front = 0;
  for (double y = -60; y <= 20; y += 4) {
    for (double z = 0; z <= 40; z += 4)
      widest = std::max(widest, SkinIn(surface_, {0, y, z}, {1, 0, 0}).x());
    back = std::max(back, SkinIn(surface_, {0, y, 0}, {0, 0, 1}).z());
    if (y < 14) front = std::min(front, SkinIn(surface_, {0, y, 0}, {0, 0, -1}).z());
  }
  EXPECT_NEAR(2 * widest, shape_.breadth_mm, 5);
  EXPECT_NEAR(back - front, shape_.length_mm, 6);
  // Menton: the lowest skin of the chin, where the surface turns back under the jaw.
  const double top = SkinIn(surface_, {0, 0, 0}, {0, -1, 0}).y();
  const double chin = SkinIn(surface_, {0, 100, -75}, {0, 1, 0}).y();
  EXPECT_NEAR(chin - top, shape_.height_mm, 7);
}

TEST_P(HeadShapeTest, NoseStandsOutBeforeTheLip) {
  double tip = 0;
  for (double y = 45; y < 70; y += 1)
    tip = std::min(tip, SkinIn(surface_, {0, y, -30}, {0, 0, -1}).z());
  const double lip = SkinIn(surface_, {0, 76, -30}, {0, 0, -1}).z();
  EXPECT_NEAR(lip - tip, shape_.nose_protrusion_mm, 6);
}

TEST_P(HeadShapeTest, IsSymmetric) {
  for (int i = 0; i < 200; ++i) {
    const Vector3d p(3.0 + 0.4 * i, -90 + 1.2 * i, -100 + 1.1 * i);
    EXPECT_NEAR(surface_.Distance(p), surface_.Distance({-p.x(), p.y(), p.z()}), 1e-9);
  }
}

TEST_P(HeadShapeTest, GridLiesOnTheSkinAndHairOutsideIt) {
  const HeadGrid grid = BuildHeadGrid(subject_, surface_, 32, 24);
  ASSERT_EQ(grid.skin.size(), 33u * 25u);
  for (std::size_t k = 0; k < grid.skin.size(); ++k) {
    EXPECT_NEAR(surface_.Distance(grid.skin[k]), 0, 0.05);
    EXPECT_NEAR((grid.outer[k] - grid.skin[k]).norm(), HairThickness(subject_, grid.skin[k]), 1e-9);
  }
  EXPECT_EQ(grid.skin_at(0, 5), grid.skin_at(32, 5));
}

TEST(HeadSurfaceTest, ShapeParametersMoveWhatTheyName) {
  HeadMeasures wide;
  wide.bizygomatic_mm = 147;
  const auto cheek = [](const HeadMeasures& shape) {
    return SkinIn(SkinSurface(shape), {0, 42, -30}, {1, 0, 0}).x();
  };
  EXPECT_NEAR(cheek(wide) - cheek({}), 5, 1.5);
  HeadMeasures nose;
  nose.nose_protrusion_mm = 25;
  const auto tip = [](const HeadMeasures& shape) {
    return SkinIn(SkinSurface(shape), {0, 57, -30}, {0, 0, -1}).z();
  };
  EXPECT_NEAR(tip({}) - tip(nose), 5, 1);
}

TEST(HeadSurfaceTest, RefusesAShapeBeyondAdultsByNameAndValue) {
  HeadMeasures shape;
  shape.breadth_mm = 90;
  try {
    SkinSurface{shape};
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("breadth_mm = 90"), std::string::npos);
  }
}

TEST(HairlineTest, ForeheadIsBareTheCrownIsNot) {
  const Subject subject = NamedSubject("adult_a");
  EXPECT_LT(InsideHairline(subject, {0, -25, -95}, false), 0);
  EXPECT_GT(InsideHairline(subject, {0, -90, 0}, false), 0);
  EXPECT_GT(InsideHairline(subject, {0, 20, 97}, false), 0);
  EXPECT_LT(InsideHairline(NamedSubject("adult_d"), {0, -90, 0}, true), 0);  // bald
}

TEST(HairlineTest, RecedesAsConfigured) {
  Subject subject = NamedSubject("adult_a");
  const double before = InsideHairline(subject, {0, -60, -85}, false);
  subject.hair.hairline_mm += 10;
  EXPECT_NEAR(before - InsideHairline(subject, {0, -60, -85}, false), 10, 1e-9);
}

TEST(SmoothMinTest, IsTheMinimumFarApartAndBelowItNearby) {
  EXPECT_EQ(SmoothMin(1, 9, 4), 1);
  EXPECT_DOUBLE_EQ(SmoothMin(2, 2, 4), 1);
}

}  // namespace
}  // namespace visavis
