#pragma once

#include <Eigen/Core>

#include "common/geometry/rigid_transform.h"

namespace visavis {

using Vector6d = Eigen::Matrix<double, 6, 1>;

/// The paper's angles [Phi, theta, psi] in rad: R_CM = Rz(Phi) Ry(theta) Rx(psi). Phi turns about
/// the optical axis z, theta about the vertical y, psi about the horizontal x.
Eigen::Matrix3d RotationFromAngles(const Eigen::Vector3d& angles);

/// Inverse of RotationFromAngles, theta in [-pi/2, pi/2] (Eq. 35, with the signs that rebuild R).
Eigen::Vector3d AnglesFromRotation(const Eigen::Matrix3d& R);

/// J_c of Eq. 7: w = J_c [Phi' theta' psi'], with w the angular velocity of M in C, expressed in C.
Eigen::Matrix3d AngularVelocityFromAngleRates(const Eigen::Vector3d& angles);

/// Inverse of J_c, Eq. 7. @throws std::domain_error within 1e-6 rad of theta = +-90 deg.
Eigen::Matrix3d AngleRatesFromAngularVelocity(const Eigen::Vector3d& angles);

/// phi = [t_x t_y t_z Phi theta psi] (m, rad) of X_CM, and back.
RigidTransform TransformFromPhi(const Vector6d& phi);
Vector6d PhiFromTransform(const RigidTransform& X_CM);

/// Recognition error of an estimate (Eqs. 33 to 36).
struct RecognitionError {
  Eigen::Vector3d position;  ///< [m] truth minus estimate, in C
  Eigen::Vector3d angles;    ///< [rad] Phi, theta, psi of dR = R_d^T R^i (Eqs. 34, 35)
  double total_angle;        ///< [rad] geodesic angle of dR, >= 0

  /// Eq. 36: position over angles.
  Vector6d Stacked() const;
};

RecognitionError ComputeRecognitionError(const RigidTransform& X_CM_truth,
                                         const RigidTransform& X_CM_estimate);

}  // namespace visavis
