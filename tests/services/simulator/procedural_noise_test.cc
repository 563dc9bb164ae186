#include "services/simulator/procedural_noise.h"

#include <gtest/gtest.h>

#include "services/simulator/colour.h"
#include "services/simulator/profile.h"

namespace visavis {
namespace {

TEST(NoiseTest, StaysWithinOneAndVariesWithPlaceAndSeed) {
  double sum = 0, squares = 0;
  int equal = 0;
  constexpr int kCount = 5000;
  for (int i = 0; i < kCount; ++i) {
    const Eigen::Vector3d p(0.37 * i, 0.21 * i, -0.13 * i);
    const double value = Noise(p, 1);
    ASSERT_LE(std::abs(value), 1);
    sum += value;
    squares += value * value;
    equal += value == Noise(p, 2);
  }
  EXPECT_NEAR(sum / kCount, 0, 0.03);
  EXPECT_GT(squares / kCount, 0.05);
  EXPECT_EQ(equal, 0);
}

TEST(NoiseTest, IsSmoothAcrossTheLattice) {
  for (const double x : {-2.0, 0.0, 3.0}) {
    const double h = 1e-6;
    EXPECT_NEAR(Noise({x - h, 0.3, 0.4}, 5), Noise({x + h, 0.3, 0.4}, 5), 1e-9);
  }
}

TEST(CellNoiseTest, NearestIsNearerThanSecondAndWithinACell) {
  for (int i = 0; i < 200; ++i) {
    const CellDistances cell = CellNoise(0.17 * i, -0.29 * i, 3);
    EXPECT_LE(cell.nearest, cell.second);
    EXPECT_LT(cell.nearest, std::sqrt(2.0));
  }
}

TEST(SmoothStepTest, TurnsRoundWithItsArguments) {
  EXPECT_EQ(SmoothStep(0, 2, -1), 0);
  EXPECT_EQ(SmoothStep(0, 2, 1), 0.5);
  EXPECT_EQ(SmoothStep(0, 2, 3), 1);
  EXPECT_EQ(SmoothStep(2, 0, 3), 0);
}

TEST(ProfileTest, PassesThroughItsPointsAndNeverOvershoots) {
  const Profile profile{{0, 0}, {1, 5}, {2, 5}, {4, -1}};
  EXPECT_EQ(profile(0), 0);
  EXPECT_DOUBLE_EQ(profile(1), 5);
  EXPECT_DOUBLE_EQ(profile(4), -1);
  EXPECT_EQ(profile(-9), 0);
  EXPECT_EQ(profile(9), -1);
  for (double x = 0; x <= 4; x += 0.01) {
    EXPECT_LE(profile(x), 5 + 1e-12);
    EXPECT_GE(profile(x), -1 - 1e-12);
  }
}

TEST(ProfileTest, RefusesArgumentsThatDoNotAscend) {
  EXPECT_THROW(Profile({{0, 1}, {0, 2}}), std::invalid_argument);
  EXPECT_THROW(Profile({{0, 1}}), std::invalid_argument);
}

TEST(ResponseCurveTest, IsSrgbBelowTheShoulderAndRises) {
  const ResponseCurve response;
  EXPECT_EQ(response.Encode(0), 0);
  EXPECT_NEAR(response.Encode(0.214f), 127.5, 1);  // mid grey of sRGB
  EXPECT_GE(response.Encode(2.4f), 254);
  EXPECT_EQ(response.Encode(99), response.Encode(2.5f));
  for (float x = 0; x < 2.5f; x += 0.01f) {
    EXPECT_LE(response.Encode(x), response.Encode(x + 0.01f));
  }
}

TEST(ResponseCurveTest, DecodeIsItsInverse) {
  const ResponseCurve response;
  for (int value = 0; value < 255; ++value) {
    EXPECT_NEAR(response.Encode(response.Decode(static_cast<std::uint8_t>(value))), value, 1);
  }
}

}  // namespace
}  // namespace visavis
