#pragma once

#include <array>
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

/// Standard deviations of a camera's numbers [px; none].
struct CameraUncertainty {
  double fx{0}, fy{0}, cx{0}, cy{0};
  std::array<double, 5> distortion{};
};

/// Standard deviations of a pose X_AB: of its position, and of a small turn about B's axes.
struct PoseUncertainty {
  std::array<double, 3> p_m{}, r_rad{};
};

/// How exactly a calibration knows the rig; all >= 0.
struct RigUncertainty {
  CameraUncertainty right, left;
  PoseUncertainty X_CL;
  std::optional<PoseUncertainty> X_HC;
};

/// A stereo rig and what carries it: what rig.yaml holds and stereo_rig_t transports.
struct RigDescription {
  StereoRig rig;
  std::optional<RigidTransform> X_HC;  ///< hand-eye: pose of the right camera in the hand
  std::optional<ArmDescription> arm;
  std::optional<RigUncertainty> uncertainty{};  ///< of a calibration; not in stereo_rig_t

  /// @throws std::invalid_argument naming field, value and rule.
  void ValidateOrThrow() const;
};

}  // namespace visavis
