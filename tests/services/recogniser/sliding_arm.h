#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "common/rigs/rig_description.h"
#include "tests/support/stereo_scene.h"

namespace visavis {

/// An arm of two joints whose kinematics one can write down: it slides along x by q[0] m, then
/// turns about y by q[1] rad.
inline const std::vector<std::string> kArmJoints = {"slide", "turn"};
inline constexpr char kArmUrdf[] = R"(<robot name="sliding_arm">
  <link name="base"/><link name="sledge"/><link name="hand"/>
  <joint name="slide" type="prismatic"><parent link="base"/><child link="sledge"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" velocity="5" effort="1"/></joint>
  <joint name="turn" type="revolute"><parent link="sledge"/><child link="hand"/>
    <axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="5" effort="1"/></joint>
</robot>)";

/// A rig on that arm, base and camera placed askew.
inline RigDescription RigOnArm(const StereoRig& rig) {
  RigDescription description;
  description.rig = rig;
  description.X_HC =
      MakeTransform(RotationFromAngles({0.2, -0.1, 0.3}), Eigen::Vector3d(0.02, 0.03, 0.1));
  description.arm = ArmDescription{
      kArmUrdf, "base", "hand",
      MakeTransform(RotationFromAngles({-0.3, 0.4, 0.1}), Eigen::Vector3d(1, 2, 0.5))};
  return description;
}

/// X_WC of that rig.
inline RigidTransform CameraOnArm(const RigDescription& rig, double slide_m, double turn_rad) {
  return rig.arm->X_WB *
         MakeTransform(ExpRotation({0, turn_rad, 0}), Eigen::Vector3d(slide_m, 0, 0)) * *rig.X_HC;
}

}  // namespace visavis
