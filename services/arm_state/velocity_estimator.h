#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "common/kinematics/arm.h"

namespace visavis {

/// Velocities of joints from their positions: the slope, at the newest reading, of the parabola
/// that fits best through those of the last window. Exact for constant acceleration, so it does not
/// lag; noise of the positions is averaged over the window: sigma_v = sigma_q / dt sqrt(192 / n^3)
/// for n >> 1 readings dt apart. Allocates nothing.
class VelocityEstimator {
 public:
  /// @param window_s  > 0; three readings are always used where they are there
  explicit VelocityEstimator(double window_s) : window_s_(window_s) {}

  /// Adds positions at @p utime_us, later than the last. @return velocities then; none for the
  /// first reading, and the straight line's slope for the second.
  std::optional<JointVector> Add(std::int64_t utime_us, const JointVector& q);

  void Reset() { size_ = 0; }

 private:
  struct Reading {
    std::int64_t utime_us;
    JointVector q;
  };
  const Reading& Back(int i) const { return ring_[(next_ + kCapacity - 1 - i) % kCapacity]; }

  static constexpr int kCapacity = 64;
  const double window_s_;
  std::array<Reading, kCapacity> ring_;
  int next_{0}, size_{0};
};

}  // namespace visavis
