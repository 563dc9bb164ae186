#include "common/geometry/head_angles.h"

#include <cmath>
#include <stdexcept>

namespace visavis {

Eigen::Matrix3d RotationFromAngles(const Eigen::Vector3d& angles) {
  const double cz = std::cos(angles[0]), sz = std::sin(angles[0]);
  const double cy = std::cos(angles[1]), sy = std::sin(angles[1]);
  const double cx = std::cos(angles[2]), sx = std::sin(angles[2]);
  Eigen::Matrix3d R;
  R << cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx,  //
      sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx,   //
      -sy, cy * sx, cy * cx;
  return R;
}

Eigen::Vector3d AnglesFromRotation(const Eigen::Matrix3d& R) {
  return {std::atan2(R(1, 0), R(0, 0)), std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))),
          std::atan2(R(2, 1), R(2, 2))};
}

Eigen::Matrix3d AngularVelocityFromAngleRates(const Eigen::Vector3d& angles) {
  const double cz = std::cos(angles[0]), sz = std::sin(angles[0]);
  const double cy = std::cos(angles[1]), sy = std::sin(angles[1]);
  Eigen::Matrix3d Jc;
  Jc << 0, -sz, cz * cy,  //
      0, cz, sz * cy,     //
      1, 0, -sy;
  return Jc;
}

Eigen::Matrix3d AngleRatesFromAngularVelocity(const Eigen::Vector3d& angles) {
  const double cz = std::cos(angles[0]), sz = std::sin(angles[0]);
  const double cy = std::cos(angles[1]), sy = std::sin(angles[1]);
  if (std::abs(cy) < 1e-6) {
    throw std::domain_error("J_c is singular: theta = " + std::to_string(angles[1]) +
                            " rad, must stay off +-pi/2");
  }
  Eigen::Matrix3d inverse;
  inverse << cz * sy / cy, sz * sy / cy, 1,  //
      -sz, cz, 0,                            //
      cz / cy, sz / cy, 0;
  return inverse;
}

RigidTransform TransformFromPhi(const Vector6d& phi) {
  return MakeTransform(RotationFromAngles(phi.tail<3>()), phi.head<3>());
}

Vector6d PhiFromTransform(const RigidTransform& X_CM) {
  Vector6d phi;
  phi << X_CM.translation(), AnglesFromRotation(X_CM.linear());
  return phi;
}

Vector6d RecognitionError::Stacked() const {
  Vector6d stacked;
  stacked << position, angles;
  return stacked;
}

RecognitionError ComputeRecognitionError(const RigidTransform& X_CM_truth,
                                         const RigidTransform& X_CM_estimate) {
  const Eigen::Matrix3d dR = X_CM_truth.linear().transpose() * X_CM_estimate.linear();
  return {X_CM_truth.translation() - X_CM_estimate.translation(), AnglesFromRotation(dR),
          LogRotation(dR).norm()};
}

}  // namespace visavis
