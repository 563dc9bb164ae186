#include "services/simulator/lighting.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace visavis {
namespace {

/// Light that a white surface towards the camera receives, green.
float OnTheFace(const Lighting& light) {
  const Eigen::Vector3f towards(0, 0, -1);
  const float key = std::max(0.0f, light.key_direction.normalized().dot(towards));
  const float fill = std::max(0.0f, light.fill_direction.normalized().dot(towards));
  return key * light.key.y() + fill * light.fill.y() + 0.5f * (light.sky.y() + light.ground.y());
}

TEST(LightingTest, ARandomLampStandsBeforeTheFaceAndLeavesItNeitherBlackNorWhite) {
  float least = 9, most = 0, leftmost = 0, rightmost = 0;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const Lighting light = Lighting::Random(seed);
    EXPECT_LT(light.key_direction.z(), 0) << seed;
    EXPECT_NEAR(light.key_direction.norm(), 1, 1e-6) << seed;
    least = std::min(least, OnTheFace(light));
    most = std::max(most, OnTheFace(light));
    leftmost = std::min(leftmost, light.key_direction.x());
    rightmost = std::max(rightmost, light.key_direction.x());
  }
  EXPECT_GT(least, 0.15f);
  EXPECT_LT(most, 1.2f);
  EXPECT_LT(leftmost, -0.9f);  // from both sides
  EXPECT_GT(rightmost, 0.9f);
}

TEST(LightingTest, ItIsTheSameForTheSameSeed) {
  EXPECT_EQ(Lighting::Random(7).key_direction, Lighting::Random(7).key_direction);
  EXPECT_NE(Lighting::Random(7).key_direction, Lighting::Random(8).key_direction);
}

}  // namespace
}  // namespace visavis
