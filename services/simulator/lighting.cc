#include "services/simulator/lighting.h"

#include <cmath>

#include "common/core/random.h"

namespace visavis {
namespace {

constexpr double kMostAside_rad = 1.4, kLowest_rad = -0.2, kHighest_rad = 1.1;

}  // namespace

Lighting Lighting::Side() {
  Lighting light;
  light.key_direction = {-0.93f, -0.26f, -0.26f};
  light.key = {1.05f, 1.00f, 0.93f};
  light.fill = {0.02f, 0.02f, 0.03f};
  light.sky = {0.10f, 0.11f, 0.13f};
  light.ground = {0.06f, 0.05f, 0.05f};
  return light;
}

Lighting Lighting::Random(std::uint64_t seed) {
  visavis::Random random(seed);
  for (int i = 0; i < 8; ++i) random.Bits();
  const auto between = [&](double least, double most) {
    return static_cast<float>(random.Uniform(least, most));
  };
  const float aside = between(-kMostAside_rad, kMostAside_rad);
  const float up = between(kLowest_rad, kHighest_rad);
  const float hard = between(0, 1), warm = between(-0.08, 0.08);
  Lighting light;
  light.key_direction = {std::cos(up) * std::sin(aside), -std::sin(up),
                         -std::cos(up) * std::cos(aside)};
  light.key = (0.35f + 0.6f * hard) * Eigen::Vector3f(1 + warm, 1, 1 - warm);
  light.key_radius = between(0.05, 0.35);
  light.fill_direction.x() = -std::copysign(light.fill_direction.x(), aside);
  const float rest = 1.15f - 0.85f * hard;
  light.fill *= rest;
  light.sky *= rest;
  light.ground *= rest * between(0.5, 1.5);
  return light;
}

}  // namespace visavis
