#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "common/kinematics/hand_eye.h"
#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"

namespace visavis {

/// The demo's hand-eye, from the shipped files.
inline HandEye LoadDemoHandEye() {
  const RigDescription rig =
      LoadRigFile(std::string(std::getenv("VISAVIS_SOURCE_DIR")) + "/common/rigs/demo_rig.yaml");
  return HandEye(Arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link), rig.arm->X_WB,
                 *rig.X_HC);
}

inline Eigen::VectorXd DemoPosture() {
  return Eigen::Map<const Eigen::VectorXd>(kDemoArmPosture.data(), 7);
}

/// X_WC of the paper's shuttle along W's x axis at phase @p turns: x = 150 mm cos(2 pi turns).
inline RigidTransform ShuttleX(double turns) {
  RigidTransform X_WC = DemoCameraPose();
  X_WC.translation().x() += 0.15 * std::cos(2 * M_PI * turns);
  return X_WC;
}

/// X_WC of the paper's orbit: at 1 m about the head's vertical, 10 deg cos(2 pi turns).
inline RigidTransform OrbitTheta(double turns) {
  const Eigen::Vector3d head = DemoHeadPose().translation();
  const Eigen::Matrix3d R = ExpRotation({0, 0, 10 * M_PI / 180 * std::cos(2 * M_PI * turns)});
  const RigidTransform X_WC = DemoCameraPose();
  return MakeTransform(Eigen::Matrix3d(R * X_WC.linear()), head + R * (X_WC.translation() - head));
}

/// @p n + 1 hand poses of one turn of a camera path, both ends included.
template <typename Path>
std::vector<RigidTransform> HandPath(const HandEye& hand_eye, const Path& path, int n) {
  std::vector<RigidTransform> X_BH;
  for (int i = 0; i <= n; ++i) X_BH.push_back(hand_eye.HandPoseFor(path(i * 1.0 / n)));
  return X_BH;
}

}  // namespace visavis
