#pragma once

#include <cstdint>

#include "common/geometry/rigid_transform.h"
#include "common/kinematics/feedforward.h"

namespace visavis {

/// The camera at the time of an exposure.
struct CameraState {
  RigidTransform X_WC;
  CameraTwist twist;    ///< zero where has_twist is false
  bool has_twist;       ///< false: one lone pose, so no velocity is known
  bool extrapolated;    ///< the time is later than all samples
  std::int64_t age_us;  ///< time of the exposure minus that of the newest sample not after it
};

}  // namespace visavis
