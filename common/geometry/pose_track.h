#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// A pose that was measured at some time.
struct StampedPose {
  std::int64_t utime_us{0};
  RigidTransform X{RigidTransform::Identity()};
};

/// Poses of one body over time, asked for at any time.
class PoseTrack {
 public:
  PoseTrack() = default;
  /// Takes poses in any order; of several at one time the last counts.
  explicit PoseTrack(std::vector<StampedPose> poses);

  bool empty() const { return poses_.empty(); }
  /// By time, each time once.
  const std::vector<StampedPose>& poses() const { return poses_; }

  /// The pose measured at this very time; null where there is none.
  const RigidTransform* Find(std::int64_t utime_us) const;

  /// The pose measured then, else interpolated between its two neighbours if these are at most
  /// @p max_gap_us apart.
  std::optional<RigidTransform> At(std::int64_t utime_us, std::int64_t max_gap_us) const;

 private:
  std::vector<StampedPose> poses_;
};

}  // namespace visavis
