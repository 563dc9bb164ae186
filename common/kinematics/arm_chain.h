#pragma once

// Internal to common/kinematics: included by its .cc files only, so that users do not see KDL.

#include <kdl/chain.hpp>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/kinematics/arm.h"

namespace visavis {

/// One KDL segment per URDF joint from base to tip, fixed ones included.
struct ArmChain {
  KDL::Chain kdl;
  std::vector<ArmJoint> joints;  ///< the moving ones, in order
};

/// Reads a URDF. What urdfdom would print goes into the exception instead.
/// @throws std::invalid_argument, see Arm::Arm().
ArmChain ReadArmChain(const std::string& urdf, const std::string& base_link,
                      const std::string& tip_link);

inline Eigen::Vector3d ToEigen(const KDL::Vector& v) { return {v.x(), v.y(), v.z()}; }

inline RigidTransform ToEigen(const KDL::Frame& X) {
  Eigen::Matrix3d R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = X.M(i, j);
  return MakeTransform(R, ToEigen(X.p));
}

inline KDL::Frame ToKdl(const RigidTransform& X) {
  const Eigen::Matrix3d R = X.linear();
  const Eigen::Vector3d p = X.translation();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1),
                        R(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

}  // namespace visavis
