#include "services/recogniser/stereo_fitness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "common/core/random.h"
#include "tests/support/naive_fitness.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

HeadModelConfig RandomHead(const std::string& shape, Random* random) {
  HeadModelConfig head;
  head.shape = shape;
  head.radius_mm = random->Uniform(80, 110);
  head.semi_axis_x_mm = random->Uniform(75, 90);
  head.semi_axis_y_mm = random->Uniform(90, 120);
  head.semi_axis_z_mm = random->Uniform(75, 110);
  head.hair_tilt_deg = random->Uniform(30, 45);
  head.hair_offset_mm = random->Uniform(-40, -25);
  head.eye_x_mm = 30;
  head.eye_half_width_mm = 10;
  head.brow_outer_x_mm = random->Uniform(40, 50);
  return head;
}

// The rig with twice the pixels: there S_in and S_out lie more than a pixel from the outline.
StereoRig Doubled(const StereoRig& rig) {
  StereoRig doubled = rig;
  for (Pinhole* camera : {&doubled.right, &doubled.left}) {
    camera->width *= 2, camera->height *= 2;
    camera->fx *= 2, camera->fy *= 2;
    camera->cx = 2 * camera->cx + 0.5, camera->cy = 2 * camera->cy + 0.5;
  }
  return doubled;
}

// Black where a ray of the camera meets the ellipsoid, white elsewhere: the outline, found without
// the model's points.
OwnedImage Silhouette(const Eigen::Vector3d& semi_axes, const Pinhole& camera,
                      const RigidTransform& X_KM, bool negative = false) {
  OwnedImage image = FlatImage(camera.width, camera.height, 255, 255, 255);
  const RigidTransform X_MK = X_KM.inverse();
  const Eigen::Vector3d o = X_MK.translation().cwiseQuotient(semi_axes);
  auto out = image.bytes.begin();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x, out += 3) {
      const Eigen::Vector3d d =
          (X_MK.linear() * Unproject(camera, {x, y})).cwiseQuotient(semi_axes);
      const double discriminant = o.dot(d) * o.dot(d) - d.squaredNorm() * (o.squaredNorm() - 1);
      if ((discriminant > 0) != negative) std::fill(out, out + 3, std::uint8_t{0});
    }
  }
  return image;
}

PackedMap MapOf(const ImageView& image, const ColorRuleConfig& rule = {}) {
  PackedMap map(image.width, image.height);
  map.Build(image, rule);
  return map;
}

// A model on a rig with both ways to add up the fitness.
struct Kernel {
  Kernel(const HeadModelConfig& head, const StereoRig& stereo_rig)
      : rig(stereo_rig),
        normalised(HeadModel(head), rig, {}),
        raw(HeadModel(head), rig, RawSums()) {}
  static FitnessConfig RawSums() {
    FitnessConfig config;
    config.normalised = false;
    return config;
  }
  const HeadModel& model() const { return normalised.model(); }
  StereoRig rig;
  StereoFitness normalised, raw;
};

struct Case {
  const char* name;
  const char* shape;
  StereoRig (*rig)();
};

class StereoFitnessTest : public ::testing::TestWithParam<Case> {
 protected:
  StereoRig rig() const { return GetParam().rig(); }
  HeadModelConfig Head(Random* random) const { return RandomHead(GetParam().shape, random); }
};
INSTANTIATE_TEST_SUITE_P(HeadsAndRigs, StereoFitnessTest,
                         ::testing::Values(Case{"SphereParallel", "sphere", SmallRig},
                                           Case{"EllipsoidParallel", "ellipsoid", SmallRig},
                                           Case{"SphereUneven", "sphere", UnevenRig},
                                           Case{"EllipsoidUneven", "ellipsoid", UnevenRig}),
                         [](const auto& tested) { return std::string(tested.param.name); });

// One black pixel where geometry's f_R and f_L put a feature point: the kernel must find it there.
TEST_P(StereoFitnessTest, Eq17To21EachFeaturePointReadsThePixelItProjectsTo) {
  Random random(17);
  const Kernel kernel(Head(&random), rig());
  const HeadModel& model = kernel.model();
  const Vector6d phi = RandomPhi(&random);
  const RigidTransform X_CM = TransformFromPhi(phi);
  for (const bool is_left : {false, true}) {
    const Pinhole& camera = is_left ? kernel.rig.left : kernel.rig.right;
    OwnedImage image = FlatImage(camera.width, camera.height, 255, 255, 255);
    PackedMap map(camera.width, camera.height);
    for (std::size_t i = 0; i < model.feature_x.size(); i += 3) {
      const auto pixel_of = [&](std::size_t k) {
        const Eigen::Vector3d p(model.feature_x[k], model.feature_y[k], model.feature_z[k]);
        const Eigen::Vector2d uv =
            (is_left ? ProjectLeft(kernel.rig, X_CM, p) : ProjectRight(kernel.rig, X_CM, p)).uv;
        return std::pair<int, int>(std::lround(uv.x()), std::lround(uv.y()));
      };
      const auto [x, y] = pixel_of(i);
      int in = 0, out = 0;  // points that share the pixel
      for (std::size_t k = 0; k < model.feature_x.size(); ++k) {
        if (pixel_of(k) == std::pair(x, y)) {
          ++(static_cast<int>(k) < model.num_feature_in() ? in : out);
        }
      }
      const auto at = static_cast<std::size_t>(3 * (y * camera.width + x));
      std::fill_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(at), 3, std::uint8_t{0});
      map.Build(image.view, {});
      const StereoMaps maps = is_left ? StereoMaps{nullptr, &map} : StereoMaps{&map, nullptr};
      EXPECT_EQ(kernel.raw.Evaluate(maps, phi).feat, 255 * (in - out)) << i << ' ' << is_left;
      std::fill_n(image.bytes.begin() + static_cast<std::ptrdiff_t>(at), 3, std::uint8_t{255});
    }
  }
}

// On the true outline's silhouette every point of S_in is black and every point of S_out white.
TEST_P(StereoFitnessTest, Eq22SInFillsTheOutlineInBothImagesAndSOutSurroundsIt) {
  Random random(22);
  for (int trial = 0; trial < 4; ++trial) {
    const Kernel kernel(Head(&random), Doubled(rig()));
    const Vector6d phi = RandomPhi(&random);
    const RigidTransform X_CM = TransformFromPhi(phi);
    const Eigen::Vector3d& axes = kernel.model().semi_axes_m();
    const OwnedImage right = Silhouette(axes, kernel.rig.right, X_CM);
    const OwnedImage left = Silhouette(axes, kernel.rig.left, kernel.rig.X_CL.inverse() * X_CM);
    const PackedMap right_map = MapOf(right.view), left_map = MapOf(left.view);
    EXPECT_EQ(kernel.normalised.Evaluate({&right_map, nullptr}, phi).site, 1);
    EXPECT_EQ(kernel.normalised.Evaluate({nullptr, &left_map}, phi).site, 1);
    EXPECT_EQ(kernel.normalised.Evaluate({&right_map, &left_map}, phi).site, 1);
    // A head's width beside it nothing fits.
    Vector6d beside = phi;
    beside[0] += 0.4;
    EXPECT_LT(kernel.normalised.Evaluate({&right_map, &left_map}, beside).site, 0.1);
  }
}

TEST_P(StereoFitnessTest, Eq22OutlinePointsAreTangent) {
  Random random(220);
  const HeadModel model(Head(&random));
  const NaiveFitness naive(model, rig(), {});
  for (int trial = 0; trial < 20; ++trial) {
    const RigidTransform X_MC = TransformFromPhi(RandomPhi(&random)).inverse();
    const Eigen::Vector3d o = X_MC.translation().cwiseQuotient(model.semi_axes_m());
    for (double angle = 0; angle < 6; angle += 0.5) {
      const Eigen::Vector3d p = naive.OutlinePoint(std::cos(angle), std::sin(angle),
                                                   X_MC.translation(), X_MC.linear().col(0));
      const Eigen::Vector3d d = p.cwiseQuotient(model.semi_axes_m()) - o;
      // The ray o + s d touches the unit sphere: its quadratic has one root, at s = 1.
      EXPECT_NEAR(o.dot(d) * o.dot(d) / (d.squaredNorm() * (o.squaredNorm() - 1)), 1, 1e-9);
      EXPECT_NEAR(-o.dot(d) / d.squaredNorm(), 1, 1e-9);
    }
  }
}

TEST_P(StereoFitnessTest, Eq22SInLiesOnTheVisibleSurface) {
  Random random(221);
  const HeadModel model(Head(&random));
  const NaiveFitness naive(model, rig(), {});
  for (int trial = 0; trial < 20; ++trial) {
    const RigidTransform X_MC = TransformFromPhi(RandomPhi(&random)).inverse();
    for (int i = 0; i < model.num_in(); ++i) {
      const Eigen::Vector3d p = naive.SurfacePoint(model.in_u[i], model.in_v[i], X_MC.translation(),
                                                   X_MC.linear().col(0));
      EXPECT_NEAR(p.cwiseQuotient(model.semi_axes_m()).squaredNorm(), 1, 1e-9);
      const Eigen::Vector3d normal = p.cwiseQuotient(model.semi_axes_m().cwiseAbs2());
      EXPECT_GT(normal.dot(X_MC.translation() - p), 0);
    }
  }
}

TEST_P(StereoFitnessTest, Eq22TheDiscsAxesAreTheImages) {
  Random random(222);
  const HeadModel model(Head(&random));
  const NaiveFitness naive(model, rig(), {});
  const RigidTransform X_CM = TransformFromPhi(RandomPhi(&random));
  const RigidTransform X_MC = X_CM.inverse();
  const auto in_camera = [&](double u, double v) -> Eigen::Vector3d {
    return X_CM * naive.OutlinePoint(u, v, X_MC.translation(), X_MC.linear().col(0));
  };
  EXPECT_GT(in_camera(1, 0).x(), in_camera(-1, 0).x() + 0.1);  // u to the right
  EXPECT_GT(in_camera(0, 1).y(), in_camera(0, -1).y() + 0.1);  // v down, where the chin's gap is
}

// On a painted head, whose hair and skin a ray tracer parted, S_in's parts see their own colour.
// Features cover some skin; the parting itself runs between pixels.
TEST_P(StereoFitnessTest, Eq23ChPartsSInIntoHairAndSkinAsPainted) {
  Random random(23);
  for (int trial = 0; trial < 4; ++trial) {
    HeadModelConfig head = Head(&random);
    head.eye_half_width_mm = 4, head.eye_half_height_mm = 2;
    head.brow_half_height_mm = 1;
    const Kernel kernel(head, rig());
    const Vector6d phi = RandomPhi(&random);
    StereoScene scene(head, rig());
    const StereoFrame frame = scene.Paint(phi);
    const PackedMap right = MapOf(*frame.right), left = MapOf(*frame.left);
    const double color = kernel.normalised.Evaluate({&right, &left}, phi).color;
    EXPECT_GT(color, 0.93);
    Vector6d tilted = phi;
    tilted[5] += 0.3;  // hair and skin parted elsewhere
    EXPECT_LT(kernel.normalised.Evaluate({&right, &left}, tilted).color, color - 0.05);
  }
}

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
