#include "services/recogniser/refined/color_contrast.h"

#include <gtest/gtest.h>

#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

const Vector6d kTruth = PhiOf(20, -10, 1000, 4, -5, 3);

class ColorContrastTest : public ::testing::Test {
 protected:
  ColorContrastTest() : scene_(TestRig()), contrast_(MeshOf(SharedAdultHead().surface, 3)) {}

  double Aside(const Vector6d& aside) const {
    return contrast_.Of(scene_.picture(0), scene_.geometry(0), TransformFromPhi(kTruth + aside));
  }

  MeshScene scene_;
  ColorContrast contrast_;
};

TEST_F(ColorContrastTest, IsOneWhereTheModelCoversTheHeadAndLessBeside) {
  scene_.Show(TransformFromPhi(kTruth), FlatHead);
  EXPECT_GT(Aside(Vector6d::Zero()), 0.95);
  for (const double mm : {-60.0, 60.0}) {
    EXPECT_LT(Aside(PhiOf(mm, 0, 0, 0, 0, 0)), 0.75) << mm;
    EXPECT_LT(Aside(PhiOf(0, mm, 0, 0, 0, 0)), 0.85) << mm;
  }
}

TEST_F(ColorContrastTest, AHeadOfAnyColoursStandsOut) {
  for (const Color& skin : {Color{60, 40, 30}, Color{30, 160, 60}, Color{250, 250, 250}}) {
    scene_.Show(TransformFromPhi(kTruth), [&](const Eigen::Vector3f&) { return skin; });
    EXPECT_GT(Aside(Vector6d::Zero()), 0.95);
  }
}

TEST_F(ColorContrastTest, AHeadOfTheWallsColourHasNone) {
  scene_.Show(TransformFromPhi(kTruth), [](const Eigen::Vector3f&) { return kSceneWall; });
  EXPECT_LT(Aside(Vector6d::Zero()), 0.01);
}

TEST_F(ColorContrastTest, OutOfThePictureAndBehindTheCameraItIsZero) {
  scene_.Show(TransformFromPhi(kTruth), FlatHead);
  EXPECT_EQ(Aside(PhiOf(3000, 0, 0, 0, 0, 0)), 0);
  EXPECT_EQ(Aside(PhiOf(0, 0, -2000, 0, 0, 0)), 0);
}

TEST_F(ColorContrastTest, GreyLevelsContrastToo) {
  scene_.ShowGray(TransformFromPhi(kTruth), FlatHead);
  ASSERT_EQ(scene_.picture(0).format, PixelFormat::kGray);
  const double there = Aside(Vector6d::Zero());
  EXPECT_GT(there, 0.5);
  EXPECT_LT(Aside(PhiOf(40, 0, 0, 0, 0, 0)), there - 0.2);
}

TEST_F(ColorContrastTest, NothingIsAllocated) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  scene_.Show(TransformFromPhi(kTruth), FlatHead);
  const std::int64_t before = NumMallocs();
  Aside(Vector6d::Zero());
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
