#include "services/simulator/background.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/geometry/rigid_transform.h"

namespace visavis {
namespace {

constexpr int kRun = Background::kRun;

/// A run of neighbouring rays.
std::array<std::uint32_t, kRun> Look(const Background& background, const Eigen::Vector3f& p,
                                     const Eigen::Matrix3f& R, float x, float y, float step) {
  std::array<float, kRun> xs, ys;
  for (int i = 0; i < kRun; ++i) {
    xs[static_cast<std::size_t>(i)] = x + step * static_cast<float>(i);
    ys[static_cast<std::size_t>(i)] = y;
  }
  std::array<std::uint32_t, kRun> rgb;
  background.Sample(p, R, xs.data(), ys.data(), rgb.data());
  return rgb;
}

Eigen::Matrix3f RotationY(float angle) {
  return Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitY()).toRotationMatrix();
}

class BackgroundTest : public ::testing::Test {
 protected:
  static const Background& Wall() {
    static const Background wall({}, 1);
    return wall;
  }
  const Eigen::Matrix3f I_ = Eigen::Matrix3f::Identity();
};

TEST_F(BackgroundTest, HasTheParallaxOfAPlaneAtItsDistance) {
  // Moved by d, the camera sees the same point of the wall at x - d / z.
  const float z = 2.2f;
  for (const float d : {-0.15f, 0.05f, 0.4f}) {
    for (const float x : {-0.3f, -0.1f, 0.0f, 0.2f}) {
      const auto before = Look(Wall(), {0, 0, 0}, I_, x, 0.05f, 0.01f);
      const auto same = Look(Wall(), {d, 0, 0}, I_, x - d / z, 0.05f, 0.01f);
      for (std::size_t i = 0; i < kRun; ++i) {
        for (const int shift : {0, 8, 16}) {
          EXPECT_NEAR((before[i] >> shift) & 255, (same[i] >> shift) & 255, 4) << d << ' ' << x;
        }
      }
    }
  }
}

TEST_F(BackgroundTest, TurnsWithTheCamera) {
  // A ray and the camera's rotation that undoes it look at the same point.
  const Eigen::Matrix3f R = RotationY(0.2f);
  const Eigen::Vector3f d = R.transpose() * Eigen::Vector3f(0.1f, 0.05f, 1);
  const auto straight = Look(Wall(), {0, 0, 0}, I_, 0.1f, 0.05f, 0);
  const auto turned = Look(Wall(), {0, 0, 0}, R, d.x() / d.z(), d.y() / d.z(), 0);
  for (const int shift : {0, 8, 16}) {
    EXPECT_NEAR((straight[0] >> shift) & 255, (turned[0] >> shift) & 255, 3);
  }
}

TEST_F(BackgroundTest, IsClutteredWithSkinWoodAndDarkParts) {
  int skin_hue = 0, dark = 0, bright = 0, count = 0;
  for (float y = -0.3f; y < 0.3f; y += 0.01f) {
    for (float x = -0.4f; x < 0.4f; x += 0.08f) {
      for (const std::uint32_t rgb : Look(Wall(), {0, 0, 0}, I_, x, y, 0.01f)) {
        const int r = rgb & 255, g = rgb >> 8 & 255, b = rgb >> 16 & 255;
        skin_hue +=
            r >= g && g > b && 2 * (g - b) < r - b && r > 50 && r - b > 30;  // 0 < H < 30 deg
        dark += r + g + b < 150;
        bright += r + g + b > 480;
        ++count;
      }
    }
  }
  EXPECT_GT(skin_hue, count / 10);
  EXPECT_GT(dark, count / 20);
  EXPECT_GT(bright, count / 10);
}

TEST_F(BackgroundTest, IsDefinedInEveryDirection) {
  for (const float angle : {0.5f, 1.5f, 2.5f, 3.1f}) {
    const auto rgb = Look(Wall(), {3, -3, 0}, RotationY(angle), -0.5f, 0.4f, 0.1f);
    for (const std::uint32_t value : rgb) EXPECT_EQ(value >> 24, 0u);
  }
}

TEST_F(BackgroundTest, WallTakesTheColourOfSkinWhenAsked) {
  BackgroundConfig config;
  config.skin_coloured = true;
  const Background skin(config, 1);
  const auto rgb = Look(skin, {0, 0, 0}, I_, 0.05f, -0.05f, 0.002f);
  for (const std::uint32_t value : rgb) {
    EXPECT_GT(value & 255, (value >> 8 & 255) + 20);
    EXPECT_GT(value >> 8 & 255, value >> 16 & 255);
  }
}

TEST_F(BackgroundTest, SameSeedSameRoomOtherSeedOtherRoom) {
  const Background again({}, 1), other({}, 2);
  int differing = 0;
  for (float x = -0.5f; x < 0.3f; x += 0.05f) {
    const auto a = Look(Wall(), {0, 0, 0}, I_, x, 0.1f, 0.006f);
    EXPECT_EQ(a, Look(again, {0, 0, 0}, I_, x, 0.1f, 0.006f));
    differing += a != Look(other, {0, 0, 0}, I_, x, 0.1f, 0.006f);
  }
  EXPECT_GT(differing, 3);
}

TEST_F(BackgroundTest, ACoarseWallIsTheSameRoom) {
  BackgroundConfig config;
  config.coarse = true;
  const Background coarse(config, 1);
  double coarse_error = 0, other_error = 0;  // of brightness
  const Background other({}, 2);
  for (float y = -0.5f; y < 0.5f; y += 0.05f) {
    for (float x = -1; x < 1; x += 0.05f) {
      const auto grey = [&](const Background& wall) {
        double sum = 0;  // over 10 mm of the wall, as wide as a coarse pixel
        for (const std::uint32_t rgb : Look(wall, {0, 0, 0}, I_, x, y, 0.00057f)) {
          sum += (rgb & 255) + (rgb >> 8 & 255) + (rgb >> 16 & 255);
        }
        return sum;
      };
      coarse_error += std::fabs(grey(coarse) - grey(Wall()));
      other_error += std::fabs(grey(other) - grey(Wall()));
    }
  }
  EXPECT_GT(coarse_error, 0);
  EXPECT_LT(coarse_error, 0.5 * other_error);  // books alias, shelves and pictures stay in place
}

TEST_F(BackgroundTest, RefusesAWallInTheHead) {
  BackgroundConfig config;
  config.wall_z_m = 0.8;
  EXPECT_THROW(Background(config, 1), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
