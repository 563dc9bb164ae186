#include "services/recogniser/refined/face_kernel.h"

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "services/recogniser/fitness_kernel.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

/// Two random series of n points and what belongs to them.
struct Series {
  Series(std::size_t size, std::uint64_t seed) : n(size) {
    Random random(seed);
    const auto fill = [&](std::vector<float>* values, std::size_t count, double scale) {
      for (std::size_t i = 0; i < count; ++i)
        values->push_back(static_cast<float>(scale * random.Normal()));
    };
    fill(&x, n, 1);
    fill(&y, n, 10);
    fill(&x_slope, 3 * n, 1000);
    fill(&y_slope, 3 * n, 1000);
    fill(&points, 3 * n, 0.1);
    for (std::size_t i = 0; i < n; ++i) {
      x_facing.push_back(static_cast<float>(random.Uniform()));
      y_facing.push_back(static_cast<float>(random.Uniform()));
      x_flags.push_back(random.Uniform() < 0.8);
      y_flags.push_back(random.Uniform() < 0.8);
    }
  }
  PairedSeries Paired(float min_facing) const {
    return {x.data(),        y.data(),        x_flags.data(), y_flags.data(),
            x_facing.data(), y_facing.data(), min_facing,     n};
  }
  bool Counts(std::size_t i, float min_facing) const {
    return x_flags[i] && y_flags[i] && x_facing[i] >= min_facing && y_facing[i] >= min_facing;
  }
  std::size_t n;
  std::vector<float> x, y, x_slope, y_slope, points, x_facing, y_facing;
  std::vector<unsigned char> x_flags, y_flags;
};

class FaceKernelTest : public ::testing::Test {
 protected:
  ~FaceKernelTest() override { SelectSimdTarget("auto"); }
};

TEST_F(FaceKernelTest, SumsOfPairsEqualOnePairAtATimeAtAnyLength) {
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (std::size_t n = 1; n < 70; ++n) {
      const Series s(n, n);
      const PairSums sums = SumPairs(s.Paired(0.3f));
      double count = 0, xy = 0, xx = 0, x = 0;
      for (std::size_t i = 0; i < n; ++i) {
        if (!s.Counts(i, 0.3f)) continue;
        count += 1;
        x += static_cast<double>(s.x[i]);
        xx += static_cast<double>(s.x[i] * s.x[i]);
        xy += static_cast<double>(s.x[i] * s.y[i]);
      }
      EXPECT_EQ(sums.n, count) << target << n;
      EXPECT_NEAR(sums.x, x, 1e-5 * (1 + std::abs(x)));
      EXPECT_NEAR(sums.xx, xx, 1e-5 * (1 + xx));
      EXPECT_NEAR(sums.xy, xy, 1e-4 * (1 + std::abs(xy)));
    }
  }
}

// The rows of more than one block of EquationRows.
TEST_F(FaceKernelTest, EquationsOfPairsEqualOnePairAtATimeOnEveryTarget) {
  const Eigen::Matrix3f R = ExpRotation({0.1, -0.3, 0.2}).cast<float>();
  for (const std::size_t n : {5, 16, 255, 256, 257, 700}) {
    const Series s(n, n);
    for (const bool both : {false, true}) {
      const PairEquations wanted{2.0f,
                                 0.5f,
                                 0.3f,
                                 0.01f,
                                 both ? s.x_slope.data() : nullptr,
                                 s.y_slope.data(),
                                 s.points.data(),
                                 &R};
      PoseEquations expected, first;
      for (std::size_t i = 0; i < n; ++i) {
        if (!s.Counts(i, 0.2f)) continue;
        const auto at = [&](const std::vector<float>& v) {
          return Eigen::Vector3f(v[3 * i], v[3 * i + 1], v[3 * i + 2]);
        };
        const float residual = 2 * s.x[i] + 0.5f - s.y[i];
        const Eigen::Vector3f slope =
            both ? Eigen::Vector3f(at(s.y_slope) - 2 * at(s.x_slope)) : at(s.y_slope);
        expected.Add(slope, R * at(s.points), residual, 0.3f / (1 + 0.01f * residual * residual));
      }
      for (const std::string& target : ListSimdTargets()) {
        SelectSimdTarget(target.c_str());
        PoseEquations equations;
        AddPairs(s.Paired(0.2f), wanted, &equations);
        EXPECT_LT((equations.H - expected.H).norm(), 1e-5 * expected.H.norm()) << target << n;
        EXPECT_LT((equations.g - expected.g).norm(), 1e-4 * expected.g.norm()) << target << n;
        if (target == ListSimdTargets().front()) first = equations;
        EXPECT_EQ(equations.H, first.H) << target;
        EXPECT_EQ(equations.g, first.g) << target;
      }
    }
  }
}

TEST(PatternSumsTest, TheCorrelationDoesNotDependOnGainAndOffset) {
  PatternSums same, other;
  for (int i = 0; i < 100; ++i) {
    const int x = i % 17 - 8, noise = i % 5;
    for (auto& [sums, y] : {std::pair(&same, x + noise), {&other, 30 * (x + noise) - 200}}) {
      sums->n += 1;
      sums->x += x;
      sums->y += y;
      sums->xx += x * x;
      sums->xy += x * y;
      sums->yy += y * y;
    }
  }
  EXPECT_GT(same.correlation(), 0.9);
  EXPECT_NEAR(other.correlation(), same.correlation(), 1e-5);
  other.n = 19;
  EXPECT_EQ(other.correlation(), 0);
  EXPECT_EQ(PatternSums{}.correlation(), 0);
}

// As many points as may be, of the largest values: no sum overflows.
TEST_F(FaceKernelTest, PatternSumsHoldTheLargestBand) {
  PatternPoints points;
  for (int i = 0; i < kMostPatternPoints; ++i)
    points.Add({0, 0, 0}, {0, 0, 0}, -1, i % 2 == 0 ? 127 : -127);
  points.Pad();
  const std::vector<std::int32_t> pairs(64, 255 * kBandSteps);
  const BandView band{pairs.data(), 8, 8, 0, 0, 0.25f};
  Pinhole camera;
  camera.width = camera.height = 32;
  camera.fx = camera.fy = 10;
  camera.cx = camera.cy = 16;
  const EyeGeometry geometry(camera, RigidTransform::Identity());
  const RigidTransform ahead = MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1));
  const KernelEye eye(geometry, EyePose(geometry, ahead));
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    const PatternSums sums = SumPattern(eye, band, points, -0.5f);
    EXPECT_EQ(sums.n, kMostPatternPoints);
    EXPECT_EQ(sums.yy, kMostPatternPoints * kLargestBandStep * kLargestBandStep);
    EXPECT_EQ(sums.xy, 0);
  }
}

// A sum over the points that count for both is that of each eye by itself where all do.
TEST_F(FaceKernelTest, AgreementIsTheCorrelationOfBothEyesSamples) {
  PatternPoints points;
  Random random(5);
  for (int i = 0; i < 61; ++i) {
    const auto draw = [&] { return static_cast<float>(random.Uniform(-0.05, 0.05)); };
    points.Add({draw(), draw(), 0}, {0, 0, -1}, 0, i);
  }
  points.Pad();
  std::vector<std::int32_t> right_pairs, left_pairs;
  for (int i = 0; i < 64; ++i) {
    right_pairs.push_back(static_cast<int>(random.Uniform(-7000, 7000)) & 0xffff);
    left_pairs.push_back(static_cast<int>(random.Uniform(-7000, 7000)) & 0xffff);
  }
  const BandView bands[] = {{right_pairs.data(), 8, 8, 0, 0, 0.25f},
                            {left_pairs.data(), 8, 8, 0, 0, 0.25f}};
  Pinhole camera;
  camera.width = camera.height = 32;
  camera.fx = camera.fy = 200;
  camera.cx = camera.cy = 16;
  const EyeGeometry geometry(camera, RigidTransform::Identity());
  const RigidTransform ahead = MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1));
  const KernelEye eye(geometry, EyePose(geometry, ahead));
  const KernelEye eyes[] = {eye, eye};
  const float highest[] = {-0.1f, -0.1f};
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    const PatternSums both = SumAgreement(eyes, bands, points, highest);
    const PatternSums right = SumPattern(eye, bands[0], points, highest[0]);
    const PatternSums left = SumPattern(eye, bands[1], points, highest[1]);
    EXPECT_EQ(both.n, 61);
    EXPECT_EQ(both.x, right.y);
    EXPECT_EQ(both.xx, right.yy);
    EXPECT_EQ(both.y, left.y);
    EXPECT_EQ(both.yy, left.yy);
    const BandView same[] = {bands[0], bands[0]};
    EXPECT_EQ(SumAgreement(eyes, same, points, highest).xy, right.yy);
    const float turned_away[] = {-0.1f, -2.0f};
    EXPECT_EQ(SumAgreement(eyes, bands, points, turned_away).n, 0);
  }
}

}  // namespace
}  // namespace visavis
