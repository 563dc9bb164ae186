#pragma once

#include "common/kinematics/arm.h"

namespace visavis {

/// A camera on an arm's hand: X_WC(q) = X_WB X_BH(q) X_HC. Immutable; allocates nothing.
class HandEye {
 public:
  /// @param X_WB  arm base in the world
  /// @param X_HC  hand-eye calibration: camera in the hand
  HandEye(Arm arm, const RigidTransform& X_WB, const RigidTransform& X_HC);

  const Arm& arm() const { return arm_; }
  const RigidTransform& X_WB() const { return X_WB_; }
  const RigidTransform& X_HC() const { return X_HC_; }

  /// X_WC at joint positions @p q.
  RigidTransform CameraPose(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// J = [J_p; J_o] of Eqs. 4 and 5, in W: v_WC = J_p qdot (of C's origin), w_WC = J_o qdot.
  JacobianMatrix CameraJacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// X_BH that puts the camera at @p X_WC: the goal for inverse kinematics.
  RigidTransform HandPoseFor(const RigidTransform& X_WC) const;

 private:
  Arm arm_;
  RigidTransform X_WB_, X_HC_, X_BW_, X_CH_;
};

}  // namespace visavis
