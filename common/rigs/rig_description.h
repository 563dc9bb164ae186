#pragma once

#include <optional>
#include <string>

#include "common/geometry/stereo_rig.h"

namespace visavis {

/// The arm that carries a rig.
struct ArmDescription {
  std::string urdf;                                 ///< URDF text
  std::string base_link;                            ///< its frame is B
  std::string tip_link;                             ///< its frame is H
  RigidTransform X_WB{RigidTransform::Identity()};  ///< pose of the base in the world
};

/// A stereo rig and what carries it: what rig.yaml holds and stereo_rig_t transports.
struct RigDescription {
  StereoRig rig;
  std::optional<RigidTransform> X_HC;  ///< hand-eye: pose of the right camera in the hand
  std::optional<ArmDescription> arm;

  /// @throws std::invalid_argument naming field, value and rule.
  void ValidateOrThrow() const;
};

}  // namespace visavis
