#include "common/kinematics/hand_eye.h"

#include <utility>

namespace visavis {

HandEye::HandEye(Arm arm, const RigidTransform& X_WB, const RigidTransform& X_HC)
    : arm_(std::move(arm)),
      X_WB_(X_WB),
      X_HC_(X_HC),
      X_BW_(X_WB.inverse()),
      X_CH_(X_HC.inverse()) {}

RigidTransform HandEye::CameraPose(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  return X_WB_ * arm_.ForwardKinematics(q) * X_HC_;
}

JacobianMatrix HandEye::CameraJacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  JacobianMatrix J = arm_.Jacobian(q, X_HC_.translation());
  for (int i = 0; i < J.cols(); ++i) {
    J.col(i).head<3>() = (X_WB_.linear() * J.col(i).head<3>()).eval();
    J.col(i).tail<3>() = (X_WB_.linear() * J.col(i).tail<3>()).eval();
  }
  return J;
}

RigidTransform HandEye::HandPoseFor(const RigidTransform& X_WC) const {
  return X_BW_ * X_WC * X_CH_;
}

}  // namespace visavis
