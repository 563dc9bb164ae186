#include "services/simulator/picture_renderer.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/simulator/bake.h"

namespace visavis {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kRadius_m = 0.1;

Pinhole Camera() { return {kWidth, kHeight, 200, 200, 79.5, 59.5, {}}; }

/// Light that makes every point of a white surface equally bright.
Lighting Even() {
  Lighting light;
  light.key.setZero();
  light.fill.setZero();
  light.sky.setConstant(0.75f);
  light.ground.setConstant(0.75f);
  return light;
}

std::vector<Part> Sphere(Label label, const Srgb& colour) {
  std::vector<Part> parts;
  parts.push_back({"sphere", MakeSphere(kRadius_m, 192, 96), UniformTexture(colour, 0, label)});
  return parts;
}

RigidTransform At(double x, double y, double z) {
  return MakeTransform(Eigen::Matrix3d::Identity().eval(), {x, y, z});
}

struct Picture {
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(3 * kWidth * kHeight);
  std::vector<std::uint8_t> labels = std::vector<std::uint8_t>(kWidth * kHeight);
  HeadPixels pixels;

  int red(int x, int y) const { return rgb[static_cast<std::size_t>(3 * (y * kWidth + x))]; }
  Label label(int x, int y) const {
    return static_cast<Label>(labels[static_cast<std::size_t>(y * kWidth + x)]);
  }
};

class PictureRendererTest : public ::testing::Test {
 protected:
  static const Background& Wall() {
    static const Background wall({}, 1);
    return wall;
  }

  Picture Render(const std::vector<const Actor*>& actors, const RigidTransform& X_SC,
                 const Pinhole& camera = Camera(), int edge_samples = 8) const {
    PictureRenderer renderer(camera, edge_samples);
    Picture picture;
    const SceneView view{actors, !actors.empty(), &Wall(), &light_};
    renderer.Render(view, X_SC, {picture.rgb.data(), kWidth, kHeight, 3 * kWidth},
                    picture.labels.data(), &picture.pixels);
    return picture;
  }

  /// Whether a pixel's ray passes through the sphere at @p p_C, and by how many pixels it clears
  /// the outline (> 0 inside).
  static double InsideOutline(const Pinhole& camera, const Eigen::Vector3d& p_C, double u,
                              double v) {
    const Eigen::Vector3d d = Unproject(camera, {u, v}).normalized();
    const double off_axis = std::acos(std::min(1.0, d.dot(p_C.normalized())));
    return (std::asin(kRadius_m / p_C.norm()) - off_axis) * camera.fx;
  }

  const Lighting light_ = Even();
  const std::vector<Part> parts_ = Sphere(Label::kSkin, Srgb(1, 1, 1));
  Actor sphere_{parts_, false};
};

TEST_F(PictureRendererTest, SilhouetteIsTheSpheresOutline) {
  for (const Eigen::Vector3d& p_C : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.2, -0.1, 0.8)}) {
    sphere_.set_X_SO(At(p_C.x(), p_C.y(), p_C.z()));
    const Picture picture = Render({&sphere_}, RigidTransform::Identity());
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const double inside = InsideOutline(Camera(), p_C, x, y);
        if (std::abs(inside) > 0.1) {
          ASSERT_EQ(picture.label(x, y) == Label::kSkin, inside > 0) << x << ' ' << y;
        }
      }
    }
  }
}

TEST_F(PictureRendererTest, SilhouetteFollowsTheLensDistortion) {
  Pinhole camera = Camera();
  camera.distortion = {-0.25, 0.05, 0.001, -0.002, 0};
  const Eigen::Vector3d p_C(0.22, 0.12, 0.8);
  sphere_.set_X_SO(At(p_C.x(), p_C.y(), p_C.z()));
  const Picture picture = Render({&sphere_}, RigidTransform::Identity(), camera);
  int inside_count = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double inside = InsideOutline(camera, p_C, x, y);
      inside_count += inside > 0;
      if (std::abs(inside) > 0.15) {
        ASSERT_EQ(picture.label(x, y) == Label::kSkin, inside > 0) << x << ' ' << y;
      }
    }
  }
  EXPECT_GT(inside_count, 1000);
}

TEST_F(PictureRendererTest, EdgePixelsMixByTheShareCovered) {
  const Eigen::Vector3d p_C(0.013, 0.007, 1);
  sphere_.set_X_SO(At(p_C.x(), p_C.y(), p_C.z()));
  const Picture with = Render({&sphere_}, RigidTransform::Identity());
  const Picture without = Render({}, RigidTransform::Identity());
  const ResponseCurve response;
  const double white = 0.75;
  double squares = 0, sum = 0;
  int edges = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (std::abs(InsideOutline(Camera(), p_C, x, y)) > 1) continue;
      const double wall =
          static_cast<double>(response.Decode(static_cast<std::uint8_t>(without.red(x, y))));
      if (wall > 0.5) continue;  // too little contrast
      constexpr int kSub = 16;
      double covered = 0;
      for (int k = 0; k < kSub * kSub; ++k) {
        covered += InsideOutline(Camera(), p_C, x + (k % kSub + 0.5) / kSub - 0.5,
                                 y + (k / kSub + 0.5) / kSub - 0.5) > 0;
      }
      const double seen =
          (static_cast<double>(response.Decode(static_cast<std::uint8_t>(with.red(x, y)))) - wall) /
          (white - wall);
      const double error = seen - covered / (kSub * kSub);
      squares += error * error;
      sum += error;
      ++edges;
    }
  }
  ASSERT_GT(edges, 40);
  EXPECT_LT(std::sqrt(squares / edges), 0.10);
  EXPECT_NEAR(sum / edges, 0, 0.03);
}

TEST_F(PictureRendererTest, CameraPoseMovesThePictureAsProjectionSays) {
  sphere_.set_X_SO(At(0, 0, 1));
  const RigidTransform X_SC = MakeTransform(ExpRotation({0.05, -0.08, 0.2}), {0.06, -0.03, 0.1});
  const Picture picture = Render({&sphere_}, X_SC);
  const Eigen::Vector3d p_C = X_SC.inverse() * Eigen::Vector3d(0, 0, 1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double inside = InsideOutline(Camera(), p_C, x, y);
      if (std::abs(inside) < 0.1) continue;
      ASSERT_EQ(picture.label(x, y) == Label::kSkin, inside > 0);
    }
  }
}

TEST_F(PictureRendererTest, BackgroundIsUntouchedAwayFromTheActor) {
  sphere_.set_X_SO(At(0, 0, 1));
  const Picture with = Render({&sphere_}, RigidTransform::Identity());
  const Picture without = Render({}, RigidTransform::Identity());
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (InsideOutline(Camera(), {0, 0, 1}, x, y) > -1.5) continue;
      ASSERT_EQ(with.red(x, y), without.red(x, y));
    }
  }
}

TEST_F(PictureRendererTest, TheNearerActorHidesTheOtherAndTheShareIsCounted) {
  const std::vector<Part> hand = Sphere(Label::kHand, Srgb(0.5, 0.4, 0.3));
  Actor occluder(hand, false);
  sphere_.set_X_SO(At(0, 0, 1));
  occluder.set_X_SO(At(0.5 * kRadius_m, 0, 0.7));
  const Picture picture = Render({&sphere_, &occluder}, RigidTransform::Identity());
  int skin = 0, alone = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      skin += picture.label(x, y) == Label::kSkin;
      alone += InsideOutline(Camera(), {0, 0, 1}, x, y) > 0;
    }
  }
  EXPECT_EQ(picture.label(79, 59), Label::kHand);
  EXPECT_EQ(picture.pixels.head_visible, skin);
  EXPECT_NEAR(static_cast<double>(picture.pixels.head), alone, 20);
  EXPECT_LT(picture.pixels.head_share(), 0.6);
  EXPECT_GT(picture.pixels.head_share(), 0.05);
}

TEST_F(PictureRendererTest, WhatLiesBeyondTheBorderCountsAsNotSeen) {
  // The sphere's centre at the left border: half of it is outside.
  sphere_.set_X_SO(At(-0.4, 0, 1));
  const Picture picture = Render({&sphere_}, RigidTransform::Identity());
  EXPECT_NEAR(picture.pixels.head_share(), 0.5, 0.06);
  sphere_.set_X_SO(At(-0.6, 0, 1));
  EXPECT_EQ(Render({&sphere_}, RigidTransform::Identity()).pixels.head_visible, 0);
}

TEST_F(PictureRendererTest, KeyLightLeavesTheFarSideDark) {
  Lighting light;
  light.key_direction = {-1, 0, 0};
  light.fill.setZero();
  light.sky.setConstant(0.02f);
  light.ground.setConstant(0.02f);
  sphere_.set_X_SO(At(0, 0, 1));
  sphere_.ComputeKeyLight(light, {});
  PictureRenderer renderer(Camera(), 8);
  Picture picture;
  renderer.Render({{&sphere_}, true, &Wall(), &light}, RigidTransform::Identity(),
                  {picture.rgb.data(), kWidth, kHeight, 3 * kWidth}, nullptr, nullptr);
  EXPECT_GT(picture.red(65, 59), 150);
  EXPECT_LT(picture.red(95, 59), 60);
}

TEST_F(PictureRendererTest, AnotherActorThrowsItsShadow) {
  Lighting light;
  light.key_direction = {0, 0, -1};
  const std::vector<Part> hand = Sphere(Label::kHand, Srgb(0.5, 0.4, 0.3));
  Actor occluder(hand, false);
  sphere_.set_X_SO(At(0, 0, 1));
  occluder.set_X_SO(At(0, 0, 0.5));
  const auto mean_key = [&] {
    double sum = 0;
    for (const auto& vertex : sphere_.parts()[0].vertices) sum += static_cast<double>(vertex.key);
    return sum;
  };
  sphere_.ComputeKeyLight(light, {});
  const double lit = mean_key();
  sphere_.ComputeKeyLight(light, {&occluder});
  EXPECT_LT(mean_key(), 0.6 * lit);
}

TEST_F(PictureRendererTest, AHollowReceivesLessLightThanTheOpen) {
  sphere_.ComputeOpenness({}, 32);
  for (const auto& vertex : sphere_.parts()[0].vertices) EXPECT_EQ(vertex.openness, 1);
  const std::vector<Part> other = Sphere(Label::kHand, Srgb(1, 1, 1));
  Actor neighbour(other, false);
  neighbour.set_X_SO(At(0.21, 0, 0));
  sphere_.ComputeOpenness({&neighbour}, 32);
  float facing = 1, averted = 0;
  for (const auto& vertex : sphere_.parts()[0].vertices) {
    if (vertex.nx > 0.99f) facing = std::min(facing, vertex.openness);
    if (vertex.nx < -0.99f) averted = std::max(averted, vertex.openness);
  }
  EXPECT_LT(facing, 0.5f);
  EXPECT_EQ(averted, 1);
}

TEST_F(PictureRendererTest, RefusesAPictureOfAnotherSizeAndOddSampleCounts) {
  PictureRenderer renderer(Camera(), 1);
  std::vector<std::uint8_t> pixels(3 * kWidth * kHeight);
  const SceneView view{{}, false, &Wall(), &light_};
  EXPECT_THROW(renderer.Render(view, RigidTransform::Identity(), {pixels.data(), 80, 60, 240},
                               nullptr, nullptr),
               std::invalid_argument);
  EXPECT_THROW(PictureRenderer(Camera(), 3), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
