// Eqs. 17 to 23: where the model lies in the images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "services/recogniser/stereo_fitness.h"
#include "tests/services/recogniser/fitness_scene.h"
#include "tests/support/naive_fitness.h"

namespace visavis {
namespace {

class ModelProjectionTest : public ::testing::TestWithParam<HeadOnRig> {
 protected:
  StereoRig rig() const { return GetParam().rig(); }
  HeadModelConfig Head(Random* random) const { return RandomHead(GetParam().shape, random); }
};
INSTANTIATE_TEST_SUITE_P(HeadsAndRigs, ModelProjectionTest, ::testing::ValuesIn(kHeadsOnRigs),
                         [](const auto& tested) { return std::string(tested.param.name); });

// One black pixel where geometry's f_R and f_L put a feature point: the kernel must find it there.
TEST_P(ModelProjectionTest, Eq17To21EachFeaturePointReadsThePixelItProjectsTo) {
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
TEST_P(ModelProjectionTest, Eq22SInFillsTheOutlineInBothImagesAndSOutSurroundsIt) {
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

TEST_P(ModelProjectionTest, Eq22OutlinePointsAreTangent) {
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

TEST_P(ModelProjectionTest, Eq22SInLiesOnTheVisibleSurface) {
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

TEST_P(ModelProjectionTest, Eq22TheDiscsAxesAreTheImages) {
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
TEST_P(ModelProjectionTest, Eq23ChPartsSInIntoHairAndSkinAsPainted) {
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

}  // namespace
}  // namespace visavis
