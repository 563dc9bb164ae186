#include "services/recogniser/fitness_kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "common/core/random.h"
#include "services/recogniser/head_model.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

constexpr int kWidth = 67, kHeight = 41;  // with the border

struct Scene {
  explicit Scene(std::uint64_t seed) : random(seed), model(HeadModelConfig{}) {
    for (std::uint32_t& pixel : pixels) pixel = static_cast<std::uint32_t>(random.Bits());
    const auto number = [&](double scale) {
      return static_cast<float>(random.Uniform(-scale, scale));
    };
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        view.disc[i][j] = number(i < 2 ? 6 : 0.1);
        view.model[i][j] = number(i < 2 ? 60 : 1);
      }
      view.hair[i] = number(0.1);
    }
    view.origin[0] = number(20);
    view.origin[1] = number(10);
    view.origin[2] = 1 + number(0.2);
    view.hair_offset = number(0.03);
    view.rho2 = 0.99f;
    view.contour_h = 0.1f;
    view.cx = 0.5f * kWidth;
    view.cy = 0.5f * kHeight;
  }
  FitnessMap map() const {
    return {pixels.data(), kWidth, static_cast<float>(kWidth - 1), static_cast<float>(kHeight - 1)};
  }
  FitnessPoints points() const {
    return {model.in_u.data(),
            model.in_v.data(),
            model.out_u.data(),
            model.out_v.data(),
            model.feature_x.data(),
            model.feature_y.data(),
            model.feature_z.data(),
            model.num_in(),
            model.num_out(),
            model.num_feature_in(),
            static_cast<int>(model.feature_x.size())};
  }
  Random random;
  HeadModel model;
  FitnessView view{};
  std::vector<std::uint32_t> pixels = std::vector<std::uint32_t>(kWidth * kHeight);
};

float Dot(const float m[3], float x, float y, float z) { return m[0] * x + m[1] * y + m[2] * z; }

// One point of the kernel's contract, in the same single precision and order of operations.
std::uint32_t Fetch(const float m[3][3], const FitnessView& view, const FitnessMap& map, float a,
                    float b, float c) {
  const float inverse_z = 1.0f / (Dot(m[2], a, b, c) + view.origin[2]);
  const float px = (Dot(m[0], a, b, c) + view.origin[0]) * inverse_z + view.cx;
  const float py = (Dot(m[1], a, b, c) + view.origin[1]) * inverse_z + view.cy;
  const int column = static_cast<int>(std::min(std::max(px, 0.0f), map.max_x));
  const int row = static_cast<int>(std::min(std::max(py, 0.0f), map.max_y));
  return map.pixels[row * map.stride + column];
}

FitnessSums SumOnePointAtATime(const FitnessView& view, const FitnessMap& map,
                               const FitnessPoints& points) {
  FitnessSums sums;
  for (int i = 0; i < points.num_in; ++i) {
    const float u = points.in_u[i], v = points.in_v[i];
    const float h = std::sqrt(1.0f - view.rho2 * (u * u + v * v));
    const std::uint32_t pixel = Fetch(view.disc, view, map, u, v, h);
    const bool is_hair = Dot(view.hair, u, v, h) > view.hair_offset;
    sums.color += is_hair ? pixel & 255 : pixel >> 8 & 255;
    sums.site_in += pixel >> 24;
  }
  for (int i = 0; i < points.num_out; ++i) {
    sums.site_out +=
        Fetch(view.disc, view, map, points.out_u[i], points.out_v[i], view.contour_h) >> 24;
  }
  for (int i = 0; i < points.num_feature; ++i) {
    const std::uint32_t pixel =
        Fetch(view.model, view, map, points.feature_x[i], points.feature_y[i], points.feature_z[i]);
    (i < points.num_feature_in ? sums.feature_in : sums.feature_out) += pixel >> 16 & 255;
  }
  return sums;
}

void ExpectEqual(const FitnessSums& a, const FitnessSums& b, const std::string& what) {
  EXPECT_EQ(a.site_in, b.site_in) << what;
  EXPECT_EQ(a.site_out, b.site_out) << what;
  EXPECT_EQ(a.color, b.color) << what;
  EXPECT_EQ(a.feature_in, b.feature_in) << what;
  EXPECT_EQ(a.feature_out, b.feature_out) << what;
}

class FitnessKernelTest : public ::testing::Test {
 protected:
  ~FitnessKernelTest() override { SelectSimdTarget("auto"); }
};

TEST_F(FitnessKernelTest, EverySimdTargetEqualsOnePointAtATimeToTheLastBit) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Scene scene(seed);
    const FitnessSums expected = SumOnePointAtATime(scene.view, scene.map(), scene.points());
    EXPECT_GT(expected.color, 0);
    for (const std::string& target : ListSimdTargets()) {
      SelectSimdTarget(target.c_str());
      FitnessSums sums;
      SumFitness(scene.view, scene.map(), scene.points(), &sums);
      ExpectEqual(sums, expected, target + " seed " + std::to_string(seed));
    }
  }
}

TEST_F(FitnessKernelTest, SumsHoldTheBrightestMap) {
  Scene scene(1);
  std::fill(scene.pixels.begin(), scene.pixels.end(), 0xffffffffu);
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    FitnessSums sums;
    SumFitness(scene.view, scene.map(), scene.points(), &sums);
    const int n_in = scene.model.num_in(), n_out = scene.model.num_out();
    ExpectEqual(sums,
                {255 * n_in, 255 * n_out, 255 * n_in, 255 * scene.model.num_feature_in(),
                 255 * scene.model.num_feature_out()},
                target);
  }
}

// All that lies round the map is not read, wherever a pose puts the points: behind the camera, at
// its centre, at infinity or nowhere.
TEST_F(FitnessKernelTest, NeverReadsOutsideTheMap) {
  constexpr int kGuard = 4 * kWidth;
  std::vector<std::uint32_t> memory(kGuard + kWidth * kHeight + kGuard, 0xffffffffu);
  std::fill_n(memory.begin() + kGuard, kWidth * kHeight, 0u);
  const FitnessMap map{memory.data() + kGuard, kWidth, static_cast<float>(kWidth - 1),
                       static_cast<float>(kHeight - 1)};
  const float infinity = std::numeric_limits<float>::infinity();
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      for (const float z : {-1.0f, 0.0f, 1e-30f, 1e30f, infinity, -infinity, std::nanf("")}) {
        for (const float x : {0.0f, 1e9f, -1e30f, infinity, std::nanf("")}) {
          Scene scene(seed);
          scene.view.origin[0] = scene.view.origin[1] = x;
          scene.view.origin[2] = z;
          FitnessSums sums;
          SumFitness(scene.view, map, scene.points(), &sums);
          ExpectEqual(sums, {}, target + " z " + std::to_string(z) + " x " + std::to_string(x));
        }
      }
    }
  }
}

TEST_F(FitnessKernelTest, EachNameSelectsItsOwnTarget) {
  const Scene scene(1);
  const auto chosen_for = [&](const std::string& name) {
    SelectSimdTarget(name.c_str());
    FitnessSums sums;
    SumFitness(scene.view, scene.map(), scene.points(), &sums);
    return ChosenSimdTarget();
  };
  std::vector<std::size_t> chosen;
  for (const std::string& target : ListSimdTargets()) chosen.push_back(chosen_for(target));
  EXPECT_EQ(chosen_for("auto"), chosen.front());  // best first
  std::sort(chosen.begin(), chosen.end());
  EXPECT_EQ(std::unique(chosen.begin(), chosen.end()), chosen.end());
}

TEST_F(FitnessKernelTest, AnUnknownTargetIsRefusedWithTheOnesOffered) {
  EXPECT_THAT([] { SelectSimdTarget("MMX"); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::AllOf(
                  ::testing::HasSubstr("MMX"), ::testing::HasSubstr(SimdTargets()))));
  EXPECT_THAT([] { SelectSimdTarget(""); }, ::testing::Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace visavis
