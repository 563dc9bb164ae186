#include "services/recogniser/refined/new_sides.h"

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/head_geometry.h"

namespace visavis {
namespace {

constexpr double kSameView_rad = 0.05;
constexpr int kSettled = 5;  ///< frames of a track before its pose is taken

}  // namespace

bool NewSides::Take(const RigidTransform& X_CM) {
  if (++tracked_in_a_row_ < kSettled) return false;
  const Eigen::Vector3d direction = TowardsCamera(X_CM);
  const bool known = std::any_of(poses_.begin(), poses_.end(), [&](const RigidTransform& X) {
    return direction.dot(TowardsCamera(X)) > std::cos(kSameView_rad);
  });
  if (!known) poses_.push_back(X_CM);
  return !known;
}

void NewSides::Forget() {
  poses_.clear();
  Unsettle();
}

}  // namespace visavis
