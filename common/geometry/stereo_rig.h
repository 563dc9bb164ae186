#pragma once

#include "common/geometry/pinhole.h"
#include "common/geometry/rigid_transform.h"

namespace visavis {

/// Two cameras, rigidly joined: C right (the reference), L left.
struct StereoRig {
  Pinhole right;
  Pinhole left;
  RigidTransform X_CL{RigidTransform::Identity()};  ///< pose of L in C

  double baseline_m() const { return X_CL.translation().norm(); }

  /// @throws std::invalid_argument naming field, value and rule.
  void ValidateOrThrow() const;
};

/// f_R of Eq. 21: pixel in the right image of a model point, p_C = X_CM p_M (Eqs. 17, 18).
Projection ProjectRight(const StereoRig& rig, const RigidTransform& X_CM,
                        const Eigen::Vector3d& p_M);

/// f_L of Eq. 21: pixel in the left image, p_L = X_LC p_C (Eqs. 19, 20).
Projection ProjectLeft(const StereoRig& rig, const RigidTransform& X_CM,
                       const Eigen::Vector3d& p_M);

}  // namespace visavis
