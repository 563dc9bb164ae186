#include "services/recogniser/enrol/view_selection.h"

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

void ViewSelection::Add(std::int64_t frame, const RigidTransform* X_CM) {
  if (X_CM == nullptr) {
    sides_.Unsettle();
  } else if (sides_.Take(*X_CM)) {
    views_.push_back({frame, *X_CM});
  }
}

std::vector<SelectedView> ViewSelection::Views(std::size_t most) const {
  if (views_.size() <= most) return views_;
  std::vector<SelectedView> chosen;
  for (std::size_t i = 0; i < most; ++i) chosen.push_back(views_[i * views_.size() / most]);
  return chosen;
}

ViewSelection::Range ViewSelection::DirectionRange() const {
  Range range{INFINITY, -INFINITY, INFINITY, -INFINITY};
  for (const SelectedView& view : views_) {
    const Eigen::Vector3d d = TowardsCamera(view.X_CM);  // (0, 0, -1) when it looks at the camera
    const double yaw = std::atan2(-d.x(), -d.z()), pitch = std::asin(-d.y());
    range.min_yaw = std::min(range.min_yaw, yaw);
    range.max_yaw = std::max(range.max_yaw, yaw);
    range.min_pitch = std::min(range.min_pitch, pitch);
    range.max_pitch = std::max(range.max_pitch, pitch);
  }
  return range;
}

}  // namespace visavis
