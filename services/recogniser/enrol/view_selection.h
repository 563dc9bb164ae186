#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/recogniser/refined/new_sides.h"

namespace visavis {

/// A frame of a recording that a head's bundle is made of.
struct SelectedView {
  std::int64_t frame;  ///< from 0
  RigidTransform X_CM;
};

/// Chooses views of a head that differ in direction, as poses come in, one a frame.
class ViewSelection {
 public:
  /// Takes frame @p frame's pose, or tells with nullptr that the head was not tracked there. A
  /// view is taken once the track has settled, if it was seen from no such direction before.
  void Add(std::int64_t frame, const RigidTransform* X_CM);

  /// At most @p most, evenly from all that were taken.
  std::vector<SelectedView> Views(std::size_t most) const;

  /// The directions in which the camera was seen from the head, of all views: least and greatest
  /// angle [rad] about the vertical (positive: the face turned to the image's right) and about the
  /// horizontal (positive: the face turned down).
  struct Range {
    double min_yaw, max_yaw, min_pitch, max_pitch;
  };
  Range DirectionRange() const;

 private:
  NewSides sides_;
  std::vector<SelectedView> views_;
};

}  // namespace visavis
