#include "services/recogniser/refined/score_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/core/random.h"
#include "services/recogniser/fitness_kernel.h"
#include "services/recogniser/refined/score_map.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

constexpr int kWidth = 64, kHeight = 48;
constexpr ScoreRings kSurface{1, {0, 0}};

Pinhole SmallCamera() {
  Pinhole camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = 100;
  camera.cx = 32;
  camera.cy = 24;
  return camera;
}

KernelEye EyeBefore(double x, double y, double z) {
  const EyeGeometry geometry(SmallCamera(), RigidTransform::Identity());
  const RigidTransform X_CM =
      MakeTransform(ExpRotation({0.1, 0.2, -0.1}), Eigen::Vector3d(x, y, z));
  return KernelEye(geometry, EyePose(geometry, X_CM));
}

class ScoreKernelTest : public ::testing::Test {
 protected:
  ~ScoreKernelTest() override { SelectSimdTarget("auto"); }
};

/// All that lies round the box and the memory is not read, wherever a pose puts the points.
TEST_F(ScoreKernelTest, NeverReadsOutsideTheBox) {
  std::vector<std::uint32_t> memory(kWidth * kHeight, 0xffffffffu);
  for (int y = 8; y < 40; ++y)
    std::fill_n(memory.begin() + y * kWidth + 16, 32, ScoreMap::kUnknown);
  const ScoreView map{memory.data(), kWidth, 16, 8, 48, 40};
  ScorePoints points;
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const auto number = [&] { return static_cast<float>(random.Uniform(-0.3, 0.3)); };
    points.Add({number(), number(), number()}, {0, 0, 0}, -1, 8 * (i % 3));
  }
  points.Pad();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (const double z : {1.0, 0.2, 0.0, -1.0, 1e-30, 1e30, infinity, std::nan("")}) {
      for (const double x : {0.0, 0.1, 1e9, -1e30, infinity, std::nan("")}) {
        const ScoreSum sum = SumScores(EyeBefore(x, x, z), map, points, kSurface, -1e9f);
        EXPECT_EQ(sum.sum, 0) << target << " " << x << " " << z;
      }
    }
  }
}

TEST_F(ScoreKernelTest, OnlyPointsTurnedBetweenTheLimitsCount) {
  const std::vector<std::uint32_t> memory(kWidth * kHeight, 0xff8080b0u);  // hair scores 48
  const ScoreView map{memory.data(), kWidth, 0, 0, kWidth, kHeight};
  ScorePoints points;
  for (const float facing : {-0.5f, -0.2f, -0.1f, 0.1f, 0.5f}) {
    points.Add({0, 0, 0}, {0, 0, 0}, facing, 0);
  }
  points.Pad();
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    const KernelEye eye = EyeBefore(0, 0, 1);
    EXPECT_EQ(SumScores(eye, map, points, kSurface, -1e9f).count, 3) << target;
    EXPECT_EQ(SumScores(eye, map, points, kSurface, -1e9f).sum, 3 * 48) << target;
    EXPECT_EQ(SumScores(eye, map, points, kSurface, -0.3f).count, 2) << target;
    EXPECT_EQ(SumScores(eye, map, points, kSurface, -0.15f).sum, 48) << target;
  }
}

TEST_F(ScoreKernelTest, ScoresAreClamped) {
  const std::vector<std::uint32_t> memory(kWidth * kHeight, 0xff00ff01u);
  const ScoreView map{memory.data(), kWidth, 0, 0, kWidth, kHeight};
  for (const auto& [shift, expected] : {std::pair(0, -50), {8, 50}, {16, -50}}) {
    ScorePoints points;
    points.Add({0, 0, 0}, {0, 0, 0}, -1, shift);
    points.Pad();
    EXPECT_EQ(SumScores(EyeBefore(0, 0, 1), map, points, kSurface, -1e9f).sum, expected) << shift;
  }
}

TEST_F(ScoreKernelTest, AVertexIsNearTheOutlineWhereItsFacingIsWithinItsReach) {
  OutlineVertices vertices;
  Random random(2);
  for (int i = 0; i < 5 * kLanes; ++i) {
    const auto number = [&](double scale) { return static_cast<float>(scale * random.Normal()); };
    vertices.normal_x.push_back(number(0.6));
    vertices.normal_y.push_back(number(0.6));
    vertices.normal_z.push_back(number(0.6));
    vertices.n_dot_p.push_back(number(0.1));
    vertices.reach.push_back(i % 7 == 0 ? -1 : 0.1f);
    vertices.reach_a_m.push_back(i % 7 == 0 ? 0 : 0.2f);
  }
  const KernelEye eye = EyeBefore(0.1, -0.05, 1);
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    std::vector<float> facing(5 * kLanes);
    std::vector<std::int32_t> near(6 * kLanes, -1);
    const int found = FindNearOutline(eye, vertices, facing.data(), near.data());
    std::vector<std::int32_t> expected;
    for (std::size_t i = 0; i < facing.size(); ++i) {
      const float value = vertices.n_dot_p[i] -
                          (vertices.normal_x[i] * eye.p_ME[0] + vertices.normal_y[i] * eye.p_ME[1] +
                           vertices.normal_z[i] * eye.p_ME[2]);
      EXPECT_NEAR(facing[i], value, 1e-5f);
      if (std::abs(facing[i]) <= vertices.reach[i] + vertices.reach_a_m[i] * eye.distance)
        expected.push_back(static_cast<std::int32_t>(i));
    }
    near.resize(static_cast<std::size_t>(found));
    EXPECT_EQ(near, expected) << target;
    EXPECT_GT(found, 5);
    EXPECT_LT(found, 5 * kLanes - 5);
  }
}

/// A step from hair to surroundings between columns 31 and 32 of all rows.
TEST_F(ScoreKernelTest, AContourIsMeasuredWhereTheColoursTurn) {
  std::vector<std::uint32_t> memory(kWidth * kHeight);
  for (int i = 0; i < kWidth * kHeight; ++i)
    memory[static_cast<std::size_t>(i)] = i % kWidth < 32 ? 0xff8080ffu : 0xff808001u;
  const ScoreView map{memory.data(), kWidth, 0, 0, kWidth, kHeight};
  const EyeGeometry geometry(SmallCamera(), RigidTransform::Identity());
  const RigidTransform ahead = MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1));
  const KernelEye eye(geometry, EyePose(geometry, ahead));
  ContourPoints points;
  for (int k = -2; k <= 2; ++k)  // 1 px apart, at column 32 + k
    points.Add({0.01f * static_cast<float>(k), 0, 0}, {1, 0, 0}, Edge::kHair, 2);
  points.Add({0.3f, 0, 0}, {1, 0, 0}, Edge::kHair, 2);  // its normal leaves the picture
  points.Add({0, 0, 0}, {1, 0, 0}, Edge::kSkin, 2);     // nothing is told of skin
  points.Pad();
  const std::vector<float> likelihoods = ContourLikelihoods();
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    EquationRows rows;
    MeasureContours(eye, map, points, 6, likelihoods, &rows);
    EXPECT_EQ(rows.n, points.n);
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_GT(rows.weight[k], 0.1f) << target;
      EXPECT_NEAR(rows.residual[k], 31.5f - (30 + static_cast<float>(k)), 0.1f) << target;
      EXPECT_NEAR(rows.slope_x[k], 100, 1e-3f);  // px a m
      EXPECT_NEAR(rows.arm_x[k], points.x[k], 1e-6f);
    }
    for (std::size_t k = 5; k < static_cast<std::size_t>(rows.n); ++k) {
      EXPECT_EQ(rows.weight[k], 0) << target << k;
      EXPECT_EQ(rows.slope_x[k], 0) << target << k;
    }
  }
}

TEST_F(ScoreKernelTest, CrossingsAreBinnedByTheirDirectionFromTheMiddle) {
  const EyeGeometry geometry(SmallCamera(), RigidTransform::Identity());
  const RigidTransform ahead = MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1));
  const KernelEye eye(geometry, EyePose(geometry, ahead));
  Crossings c;
  c.n = 200;
  for (std::size_t i = 0; i < 200; ++i) {
    const double angle = 0.0317 * static_cast<double>(i);
    const auto x = static_cast<float>(0.1 * std::cos(angle)),
               y = static_cast<float>(0.1 * std::sin(angle));
    c.ax[i] = 2 * x;
    c.ay[i] = 2 * y;
    c.bx[i] = c.by[i] = c.az[i] = c.bz[i] = 0;
    c.facing_a[i] = -1;
    c.facing_b[i] = 1;  // half way
  }
  const float middle[2] = {0, 0};
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    PlaceCrossings(eye, middle, 96, &c);
    for (std::size_t i = 0; i < 200; ++i) {
      EXPECT_NEAR(c.distance[i], 0.01f, 1e-6f);
      EXPECT_NEAR(c.x[i], 0.5f * c.ax[i], 1e-7f);
      const double turn = 48 + 96 * std::atan2(c.ay[i], c.ax[i]) / (2 * M_PI);
      if (std::abs(turn - std::round(turn)) < 0.002) continue;  // between two bins
      EXPECT_EQ(c.bin[i], static_cast<int>(turn)) << target;
    }
  }
}

}  // namespace
}  // namespace visavis
