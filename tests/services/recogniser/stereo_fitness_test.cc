// Eqs. 24 to 32: what the images say to it.
#include "services/recogniser/stereo_fitness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/services/recogniser/fitness_scene.h"
#include "tests/support/naive_fitness.h"

namespace visavis {
namespace {

class StereoFitnessTest : public ::testing::TestWithParam<HeadOnRig> {
 protected:
  StereoRig rig() const { return GetParam().rig(); }
  HeadModelConfig Head(Random* random) const { return RandomHead(GetParam().shape, random); }
};
INSTANTIATE_TEST_SUITE_P(HeadsAndRigs, StereoFitnessTest, ::testing::ValuesIn(kHeadsOnRigs),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Kernel and twin over random heads, poses and pictures. Single precision may round a point to the
// next pixel: then one point differs, rarely; most evaluations must be equal.
TEST_P(StereoFitnessTest, Eq24To32KernelEqualsTheNaiveTwin) {
  Random random(24);
  constexpr int kTrials = 60;
  int equal = 0;
  double differences = 0;
  const OwnedImage right = NoiseImage(rig().right.width, rig().right.height, &random);
  const OwnedImage left = NoiseImage(rig().left.width, rig().left.height, &random);
  for (int trial = 0; trial < kTrials; ++trial) {
    const HeadModelConfig head = Head(&random);
    const Kernel kernel(head, rig());
    Vector6d phi = RandomPhi(&random);
    if (trial % 3 == 1) phi[0] += 0.35;  // partly outside the right image
    if (trial % 3 == 2) phi[1] -= 0.25;
    ColorRuleConfig rule;
    rule.hair_min_p = 100 + random.Index(120);
    rule.skin_min_value = random.Index(100);
    rule.skin_min_saturation = random.Index(100);
    const PackedMap right_map = MapOf(right.view, rule), left_map = MapOf(left.view, rule);
    const NaiveFitness naive(kernel.model(), rig(), rule);
    const Fitness f = kernel.normalised.Evaluate({&right_map, &left_map}, phi);
    const Fitness g = naive.Evaluate(right.view, left.view, phi);
    const double difference = std::max({std::abs(f.site - g.site), std::abs(f.color - g.color),
                                        std::abs(f.feat - g.feat), std::abs(f.total - g.total)});
    if (difference < 1e-9) ++equal;
    differences += difference;
    // Never more than what three of the fewest points can make.
    EXPECT_LT(difference, 3.0 / (2 * kernel.model().num_feature_in())) << trial;
  }
  EXPECT_GE(equal, kTrials * 2 / 3);
  EXPECT_LT(differences / kTrials, 0.002);
}

TEST_P(StereoFitnessTest, Eq24OnAFlatPictureTheBrightnessInsideAndOutsideCancels) {
  Random random(240);
  const Kernel kernel(Head(&random), rig());
  const OwnedImage right = FlatImage(rig().right.width, rig().right.height, 90, 90, 90);
  const OwnedImage left = FlatImage(rig().left.width, rig().left.height, 90, 90, 90);
  const PackedMap right_map = MapOf(right.view), left_map = MapOf(left.view);
  const Vector6d phi = PhiOf(0, 0, 1100, 5, -5, 5);
  EXPECT_NEAR(kernel.normalised.Evaluate({&right_map, &left_map}, phi).site, 0, 1e-12);
  // Raw sums weigh by the numbers of points.
  EXPECT_EQ(kernel.raw.Evaluate({&right_map, &left_map}, phi).site,
            165 * (kernel.model().num_in() - kernel.model().num_out()));
}

struct Silhouettes {
  Silhouettes(const Kernel& kernel, const Vector6d& phi, bool negative)
      : right(Silhouette(kernel.model().semi_axes_m(), kernel.rig.right, TransformFromPhi(phi),
                         negative)),
        left(Silhouette(kernel.model().semi_axes_m(), kernel.rig.left,
                        kernel.rig.X_CL.inverse() * TransformFromPhi(phi), negative)),
        right_map(MapOf(right.view)),
        left_map(MapOf(left.view)) {}
  OwnedImage right, left;
  PackedMap right_map, left_map;
};

TEST_P(StereoFitnessTest, Eq25FSiteIsTheCamerasMeanAndNeverBelowZero) {
  Random random(25);
  const Kernel kernel(Head(&random), Doubled(rig()));
  const Vector6d phi = PhiOf(10, 20, 1050, 5, -5, 5);
  const Silhouettes good(kernel, phi, false), bad(kernel, phi, true);
  EXPECT_EQ(kernel.normalised.Evaluate({&bad.right_map, &bad.left_map}, phi).site, 0);
  EXPECT_EQ(kernel.raw.Evaluate({&bad.right_map, &bad.left_map}, phi).site, 0);
  EXPECT_EQ(kernel.normalised.Evaluate({&bad.right_map, nullptr}, phi).site, 0);
  // The mean is clamped, not each camera: +1 and -1 give 0, not 1/2.
  EXPECT_EQ(kernel.normalised.Evaluate({&good.right_map, &bad.left_map}, phi).site, 0);
  EXPECT_EQ(kernel.normalised.Evaluate({&good.right_map, &good.left_map}, phi).site, 1);
  PackedMap white(kernel.rig.left.width, kernel.rig.left.height);
  EXPECT_EQ(kernel.normalised.Evaluate({&good.right_map, &white}, phi).site, 0.5);
}

TEST_P(StereoFitnessTest, Eq28And29FColorCountsSkinOnSkinAndHairOnHair) {
  Random random(28);
  const Kernel kernel(Head(&random), rig());
  const Vector6d phi = PhiOf(0, 0, 1100, 0, 0, 0);
  const auto flat_map = [&](const Pinhole& camera, int r, int g, int b) {
    return MapOf(FlatImage(camera.width, camera.height, static_cast<std::uint8_t>(r),
                           static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b))
                     .view);
  };
  const PackedMap skin_right = flat_map(kernel.rig.right, 224, 172, 140),
                  hair_right = flat_map(kernel.rig.right, 5, 5, 5),
                  hair_left = flat_map(kernel.rig.left, 5, 5, 5),
                  blue_left = flat_map(kernel.rig.left, 40, 90, 250);
  const double skin_part = kernel.normalised.Evaluate({&skin_right, nullptr}, phi).color;
  const double hair_part = kernel.normalised.Evaluate({&hair_right, nullptr}, phi).color;
  EXPECT_GT(skin_part, 0.2);
  EXPECT_GT(hair_part, 0.2);
  EXPECT_NEAR(skin_part + hair_part, 1, 1e-12);
  EXPECT_EQ(kernel.normalised.Evaluate({nullptr, &blue_left}, phi).color, 0);
  EXPECT_NEAR(kernel.normalised.Evaluate({&skin_right, &blue_left}, phi).color, skin_part / 2,
              1e-12);
  EXPECT_NEAR(
      kernel.raw.Evaluate({&skin_right, &hair_left}, phi).color,
      kernel.model().num_in() * kernel.normalised.Evaluate({&skin_right, &hair_left}, phi).color,
      1e-9);
}

TEST_P(StereoFitnessTest, Eq30And31FFeatIsPositiveOnPaintedBrowsAndEyesAlone) {
  Random random(30);
  const HeadModelConfig head = Head(&random);
  const Kernel kernel(head, rig());
  const Vector6d phi = PhiOf(5, -5, 950, 3, -4, 2);
  StereoScene scene(head, rig());
  const StereoFrame frame = scene.Paint(phi);
  const PackedMap right = MapOf(*frame.right), left = MapOf(*frame.left);
  const double there = kernel.normalised.Evaluate({&right, &left}, phi).feat;
  EXPECT_GT(there, 0.25);
  for (const double dy : {-0.03, 0.03}) {
    Vector6d off = phi;
    off[1] += dy;
    EXPECT_LT(kernel.normalised.Evaluate({&right, &left}, off).feat, there / 2) << dy;
  }
  EXPECT_NEAR(kernel.normalised.Evaluate({&right, nullptr}, phi).feat / 2 +
                  kernel.normalised.Evaluate({nullptr, &left}, phi).feat / 2,
              there, 1e-12);
  // Raw: the two sets have as many points, so only the scale differs.
  ASSERT_EQ(kernel.model().num_feature_in(), kernel.model().num_feature_out());
  EXPECT_NEAR(kernel.raw.Evaluate({&right, &left}, phi).feat,
              255 * kernel.model().num_feature_in() * there, 1e-6);
}

TEST_P(StereoFitnessTest, Eq32FIsTheSumOfTheTermsThatAreInUse) {
  Random random(32);
  const HeadModelConfig head = Head(&random);
  const Vector6d phi = PhiOf(0, 10, 1000, 3, -4, 2);
  StereoScene scene(head, rig());
  const StereoFrame frame = scene.Paint(phi);
  const PackedMap right = MapOf(*frame.right), left = MapOf(*frame.left);
  for (int bits = 0; bits < 8; ++bits) {
    FitnessConfig config;
    config.use_site = bits & 1;
    config.use_color = bits & 2;
    config.use_feat = bits & 4;
    const Fitness f = StereoFitness(HeadModel(head), rig(), config).Evaluate({&right, &left}, phi);
    EXPECT_GT(f.site, 0.1);
    EXPECT_GT(f.color, 0.1);
    EXPECT_GT(f.feat, 0.1);
    EXPECT_NEAR(f.total,
                (bits & 1 ? f.site : 0) + (bits & 2 ? f.color : 0) + (bits & 4 ? f.feat : 0),
                1e-12);
  }
}

TEST_P(StereoFitnessTest, Eq32TheSilhouettesRawSiteIsItsPointsTimes255) {
  Random random(320);
  const Kernel kernel(Head(&random), Doubled(rig()));
  const Vector6d phi = PhiOf(0, 10, 1000, 3, -4, 2);
  const Silhouettes silhouettes(kernel, phi, false);
  EXPECT_EQ(kernel.raw.Evaluate({&silhouettes.right_map, &silhouettes.left_map}, phi).site,
            255 * kernel.model().num_in());
}

// Along each of the six parameters the greatest F of a scan lies at the painted pose, to within
// what pixels and points resolve.
TEST_P(StereoFitnessTest, Eq32FIsGreatestAtThePaintedPose) {
  Random random(321);
  const HeadModelConfig head = Head(&random);
  const Kernel kernel(head, Doubled(rig()));
  const Vector6d phi = PhiOf(20, -10, 950, 4, -6, 3);
  StereoScene scene(head, kernel.rig);
  const StereoFrame frame = scene.Paint(phi);
  const PackedMap right = MapOf(*frame.right), left = MapOf(*frame.left);
  const Vector6d step = PhiOf(2, 2, 6, 1, 1, 1), resolved = PhiOf(2, 2, 12, 2, 2, 2);
  for (int k = 0; k < 6; ++k) {
    double best = 0, best_off = 0, least = 10;
    for (int i = -15; i <= 15; ++i) {
      Vector6d off = phi;
      off[k] += i * step[k];
      const double f = kernel.normalised.Evaluate({&right, &left}, off).total;
      if (f > best) best = f, best_off = i * step[k];
      least = std::min(least, f);
    }
    EXPECT_LE(std::abs(best_off), resolved[k]) << "parameter " << k;
    EXPECT_GT(best, least + 0.15) << "parameter " << k;
  }
}

TEST_P(StereoFitnessTest, AGrayPictureHasNoColorAndTheSameSiteAndFeatures) {
  Random random(33);
  const HeadModelConfig head = Head(&random);
  const Kernel kernel(head, rig());
  const Vector6d phi = PhiOf(20, -10, 1000, 4, -6, 3);
  StereoScene scene(head, rig());
  const StereoFrame frame = scene.Paint(phi);
  const OwnedImage gray_right = GrayImage(*frame.right), gray_left = GrayImage(*frame.left);
  const PackedMap right = MapOf(*frame.right), left = MapOf(*frame.left),
                  right_gray = MapOf(gray_right.view), left_gray = MapOf(gray_left.view);
  const Fitness color = kernel.normalised.Evaluate({&right, &left}, phi);
  const Fitness gray = kernel.normalised.Evaluate({&right_gray, &left_gray}, phi);
  EXPECT_EQ(gray.color, 0);
  EXPECT_EQ(gray.site, color.site);
  EXPECT_EQ(gray.feat, color.feat);
  EXPECT_GT(color.color, 0.5);
  EXPECT_NEAR(gray.total, gray.site + gray.feat, 1e-12);
}

TEST_P(StereoFitnessTest, AHeadWhollyOutsideBothImagesHasNoFitness) {
  Random random(34);
  const Kernel kernel(Head(&random), rig());
  const OwnedImage right = NoiseImage(rig().right.width, rig().right.height, &random);
  const OwnedImage left = NoiseImage(rig().left.width, rig().left.height, &random);
  const PackedMap right_map = MapOf(right.view), left_map = MapOf(left.view);
  for (const Vector6d& phi : {PhiOf(3000, 0, 1000, 0, 0, 0), PhiOf(-3000, 0, 1000, 0, 0, 0),
                              PhiOf(0, 3000, 1000, 0, 0, 0), PhiOf(0, -3000, 1000, 0, 0, 0)}) {
    const Fitness f = kernel.normalised.Evaluate({&right_map, &left_map}, phi);
    EXPECT_EQ(f.site, 0);
    EXPECT_EQ(f.color, 0);
    EXPECT_EQ(f.feat, 0);
    EXPECT_EQ(f.total, 0);
  }
}

TEST_P(StereoFitnessTest, WithoutAnyPictureFIsZero) {
  Random random(35);
  const Kernel kernel(Head(&random), rig());
  EXPECT_EQ(kernel.normalised.Evaluate({}, PhiOf(0, 0, 1000, 0, 0, 0)).total, 0);
}

TEST_P(StereoFitnessTest, EvaluatesAtLeast800PointsAPair) {
  Random random(36);
  const Kernel kernel(Head(&random), rig());
  EXPECT_GE(kernel.normalised.num_points(), 800);
  EXPECT_EQ(kernel.normalised.num_points(), 2 * kernel.model().num_points());
}

}  // namespace
}  // namespace visavis
