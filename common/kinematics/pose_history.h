#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/kinematics/camera_state.h"
#include "common/kinematics/sample_times.h"

namespace visavis {

/// The latest poses of a camera in the world, to be read at the times of exposures. Position is
/// interpolated along a line, rotation along the shortest arc; beyond the newest both go on.
/// Add() and At() allocate nothing.
class PoseHistory {
 public:
  /// Poses come at about the rate of the images, down to a few a second.
  static constexpr HistoryOptions kDefaults{256, 500'000};

  explicit PoseHistory(const HistoryOptions& options = kDefaults);

  /// Offers X_WC at @p utime_us. Every sample is counted.
  SampleVerdict Add(std::int64_t utime_us, const RigidTransform& X_WC);

  /// None before the oldest sample, in a gap wider than max_gap_us, or later than one period after
  /// the newest. The twist is that of the two poses around the time; on a lone one it is unknown.
  std::optional<CameraState> At(std::int64_t utime_us) const;

  void Clear() { times_.Clear(); }

  std::optional<std::int64_t> newest_us() const { return times_.newest_us(); }
  const SampleCounts& counts() const { return counts_; }

  /// Why the latest rejected sample was rejected: field, value, rule. Empty if none was.
  std::string DescribeLastRejection() const;

 private:
  SampleTimes times_;
  std::vector<RigidTransform> poses_;
  SampleCounts counts_;
  SampleVerdict rejected_as_{SampleVerdict::kAccepted};
  std::int64_t rejected_us_{0}, newest_us_at_rejection_{0};
};

}  // namespace visavis
