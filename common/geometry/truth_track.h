#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// The true pose of the head at one time.
struct TruthSample {
  std::int64_t utime_us{0};
  std::optional<RigidTransform> X_CM;  ///< nothing: known that no head is there
  std::optional<RigidTransform> X_WM;  ///< where the camera's pose is known too
};

/// Truth over the time of a recording, asked for at the times of its frames.
///
/// A recording whose truth carries the frames' own times (imported, simulated: at least half of the
/// samples, or of the frames if these are fewer, find their partner) has truth at these times
/// alone: a frame without a sample is unknown. Otherwise (cameras with clocks of their own) truth
/// is interpolated between two samples at most 0.1 s apart, never across a jump: there, a frame has
/// the truth of a sample at most kSameExposure_us away, as the clocks' error is no more.
class TruthTrack {
 public:
  /// A jump: farther than one of these from the sample before, after the camera's own motion has
  /// been taken out (X_WM compared; X_CM, as if the camera stood still, where X_WM is not known).
  /// The head's return after it was away counts as a jump too.
  static constexpr double kJump_m = 0.030;
  static constexpr double kJump_rad = 10 * 3.14159265358979323846 / 180;

  static constexpr std::int64_t kSameExposure_us = 1000;

  TruthTrack() = default;
  /// Takes samples in any order; of several at one time the last counts.
  TruthTrack(std::vector<TruthSample> samples, const std::vector<std::int64_t>& frame_utimes_us);

  /// Truth at the time of a frame; nothing: unknown. X_WM is set only where a sample has it.
  std::optional<TruthSample> At(std::int64_t utime_us) const;

  /// Times of the first sample after each jump; of cameras with clocks of their own, of the first
  /// frame that may show it: kSameExposure_us earlier.
  const std::vector<std::int64_t>& jump_utimes_us() const { return jump_utimes_us_; }
  const std::vector<TruthSample>& samples() const { return samples_; }
  /// Whether truth carries the frames' own times.
  bool is_synchronous() const { return synchronous_; }

 private:
  std::vector<TruthSample> samples_;
  std::vector<std::int64_t> jump_utimes_us_;
  bool synchronous_{true};
};

}  // namespace visavis
