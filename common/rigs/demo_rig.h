#pragma once

#include <array>

#include "common/geometry/rigid_transform.h"
#include "common/rigs/rig_description.h"

namespace visavis {

/// demo_rig.yaml with demo_arm.urdf, as compiled in.
RigDescription DemoRig();

// What demo_rig.yaml and demo_arm.urdf do not say: where the demo's camera and head stand.

/// A good working posture of the demo arm [rad]; its camera is within 1 mm and 0.1 deg of
/// DemoCameraPose(). Start and preferred position for inverse kinematics.
inline constexpr std::array<double, 7> kDemoArmPosture{-0.208, -0.539, -0.536, 1.559,
                                                       0.172,  -1.075, 0.051};

/// X_WC0: the nominal pose of the right camera, 1.2 m above the floor, looking along W's y axis;
/// its x axis is W's, its y axis points down.
inline RigidTransform DemoCameraPose() {
  Eigen::Matrix3d R_WC;
  R_WC << 1, 0, 0,  //
      0, 0, 1,      //
      0, -1, 0;
  return MakeTransform(R_WC, {0, 0, 1.2});
}

/// X_WM0: a head 1 m in front of the nominal camera, upright, looking straight into it.
inline RigidTransform DemoHeadPose() {
  RigidTransform X_CM = RigidTransform::Identity();
  X_CM.translation().z() = 1.0;
  return DemoCameraPose() * X_CM;
}

}  // namespace visavis
