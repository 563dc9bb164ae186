#pragma once

#include <cmath>
#include <cstdint>
#include <random>

namespace visavis {

/// Seeded random numbers that are the same on every machine and library (the distributions of the
/// standard library are not).
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  std::uint64_t Bits() { return engine_(); }
  /// Uniform in [0, 1).
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  double Uniform(double min, double max) { return min + (max - min) * Uniform(); }
  /// Uniform in 0 .. n - 1; @p n > 0.
  int Index(int n) {
    return static_cast<int>(
        (static_cast<unsigned __int128>(engine_()) * static_cast<unsigned>(n)) >> 64);
  }
  /// Normal with mean 0 and standard deviation 1 (Box-Muller).
  double Normal() {
    const double u = 1.0 - Uniform(), v = Uniform();
    return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace visavis
