#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>

namespace visavis {

/// Smooth step from 0 at @p a to 1 at @p b (a > b turns it round).
inline double SmoothStep(double a, double b, double x) {
  const double t = std::fmin(std::fmax((x - a) / (b - a), 0.0), 1.0);
  return t * t * (3 - 2 * t);
}

/// exp(-|d|^2): a bump of height 1.
inline double Bump(const Eigen::Vector3d& d) { return std::exp(-d.squaredNorm()); }

/// Scrambled bits of three lattice coordinates and a seed; the same on every machine.
inline std::uint32_t LatticeHash(std::int32_t x, std::int32_t y, std::int32_t z,
                                 std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                    static_cast<std::uint32_t>(y) * 0xd8163841u ^
                    static_cast<std::uint32_t>(z) * 0xcb1ab31fu ^ seed * 0x9e3779b9u;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  return h ^ (h >> 15);
}

/// Value noise: continuous with its gradient, values in [-1, 1], lattice spacing 1.
double Noise(const Eigen::Vector3d& p, std::uint32_t seed);

/// Sum of @p octaves of Noise, each of twice the frequency and half the amplitude; in (-2, 2).
double FractalNoise(const Eigen::Vector3d& p, int octaves, std::uint32_t seed);

/// Distances from @p p to the nearest two of one random point per lattice cell, in x and y.
struct CellDistances {
  double nearest, second;
  std::uint32_t nearest_hash;  ///< identifies the cell
};
CellDistances CellNoise(double x, double y, std::uint32_t seed);

}  // namespace visavis
