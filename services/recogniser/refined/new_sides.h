#pragma once

#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// The sides that a head was seen from: one pose for each direction, taken once a track has
/// settled.
class NewSides {
 public:
  /// The track was lost, or its frame has moved: what follows must settle anew.
  void Unsettle() { tracked_in_a_row_ = 0; }
  /// A frame of the track. Whether the head is seen from no direction that was taken before; then
  /// this one is taken.
  bool Take(const RigidTransform& X_CM);
  void Forget();

  const std::vector<RigidTransform>& poses() const { return poses_; }  ///< X_CM, as they were taken
  /// The pose of side @p i in another frame of the head.
  void SetPose(std::size_t i, const RigidTransform& X_CM) { poses_[i] = X_CM; }

 private:
  std::vector<RigidTransform> poses_;
  int tracked_in_a_row_{0};
};

}  // namespace visavis
