#include "services/simulator/procedural_noise.h"

#include <algorithm>

namespace visavis {
namespace {

double LatticeValue(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t seed) {
  return static_cast<double>(LatticeHash(x, y, z, seed)) * (2.0 / 4294967295.0) - 1.0;
}

double Fade(double t) { return t * t * (3 - 2 * t); }

double Mix(double a, double b, double t) { return a + (b - a) * t; }

}  // namespace

double Noise(const Eigen::Vector3d& p, std::uint32_t seed) {
  const double fx = std::floor(p.x()), fy = std::floor(p.y()), fz = std::floor(p.z());
  const auto x = static_cast<std::int32_t>(fx), y = static_cast<std::int32_t>(fy),
             z = static_cast<std::int32_t>(fz);
  const double u = Fade(p.x() - fx), v = Fade(p.y() - fy), w = Fade(p.z() - fz);
  const auto plane = [&](std::int32_t k) {
    return Mix(Mix(LatticeValue(x, y, k, seed), LatticeValue(x + 1, y, k, seed), u),
               Mix(LatticeValue(x, y + 1, k, seed), LatticeValue(x + 1, y + 1, k, seed), u), v);
  };
  return w == 0 ? plane(z) : Mix(plane(z), plane(z + 1), w);
}

double FractalNoise(const Eigen::Vector3d& p, int octaves, std::uint32_t seed) {
  double sum = 0, amplitude = 1;
  Eigen::Vector3d q = p;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * Noise(q, seed + static_cast<std::uint32_t>(i));
    amplitude *= 0.5;
    q = 2.03 * q + Eigen::Vector3d::Constant(17.3);
  }
  return sum;
}

CellDistances CellNoise(double x, double y, std::uint32_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  CellDistances result{1e9, 1e9, 0};
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const double cell_x = fx + i, cell_y = fy + j;
      const std::uint32_t h = LatticeHash(static_cast<std::int32_t>(cell_x),
                                          static_cast<std::int32_t>(cell_y), 0, seed);
      const double dx = cell_x + (h & 0xffff) / 65535.0 - x;
      const double dy = cell_y + (h >> 16) / 65535.0 - y;
      const double distance = std::sqrt(dx * dx + dy * dy);
      if (distance < result.nearest) {
        result = {distance, result.nearest, h};
      } else {
        result.second = std::min(result.second, distance);
      }
    }
  }
  return result;
}

}  // namespace visavis
