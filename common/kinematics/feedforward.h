#pragma once

#include <Eigen/Core>

#include "common/geometry/head_angles.h"
#include "common/kinematics/arm.h"

namespace visavis {

// Motion feedforward, Eqs. 1 to 16: how the head's pose in the camera changes because the camera
// moves. phi = [t_x t_y t_z Phi theta psi] (m, rad) is the pose of X_CM, each individual with its
// own. Nothing here allocates.

/// Velocity of C in W, expressed in W; v is that of C's origin.
struct CameraTwist {
  Eigen::Vector3d v_WC{Eigen::Vector3d::Zero()};  ///< [m/s]
  Eigen::Vector3d w_WC{Eigen::Vector3d::Zero()};  ///< [rad/s]
};

/// Individuals of a population, one a column: in memory an array [n][6].
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// Eq. 1: p_CM = R_CW (p_WM - p_WC) [m].
Eigen::Vector3d PositionInCamera(const RigidTransform& X_WC, const Eigen::Vector3d& p_WM);

/// Eq. 2: velocity of M's origin seen from C, v_CM = R_CW (v_WM - v_WC) + [w_CW x] p_CM [m/s].
Eigen::Vector3d VelocityInCamera(const RigidTransform& X_WC, const CameraTwist& camera,
                                 const Eigen::Vector3d& p_WM, const Eigen::Vector3d& v_WM);

/// Eq. 3: w_CM = R_CW (w_WM - w_WC) [rad/s], angular velocity of M in C, expressed in C.
Eigen::Vector3d AngularVelocityInCamera(const Eigen::Matrix3d& R_WC, const Eigen::Vector3d& w_WC,
                                        const Eigen::Vector3d& w_WM);

/// Eqs. 4 and 5: v_WC = J_p qdot, w_WC = J_o qdot, with J in W as HandEye::CameraJacobian() gives.
CameraTwist TwistFromJoints(const JacobianMatrix& J, const Eigen::Ref<const Eigen::VectorXd>& qdot);

/// The twist [J_p qdot; J_o qdot] replaced by two camera poses @p dt_s apart (CAMERA_POSE).
/// @pre dt_s > 0, else std::invalid_argument.
CameraTwist TwistBetween(const RigidTransform& X_WC1, const RigidTransform& X_WC2, double dt_s);

/// Eq. 6 with the minus sign that Eq. 14 gives and the print lacks:
/// [w_CW x] = -R_CW [w_WC x] R_WC, the angular velocity of W in C, expressed in C.
Eigen::Matrix3d WorldRotationInCamera(const Eigen::Matrix3d& R_WC, const Eigen::Vector3d& w_WC);

/// J_m of Eq. 8, 6 x joints: phi' = J_m qdot for a head at rest in W.
///   [ -R_CW J_p + R_CW [(R_WC p_CM) x] J_o ]
///   [ -J_c^-1 R_CW J_o                     ]
/// @param J  camera Jacobian in W. @throws std::domain_error at theta = +-90 deg.
JacobianMatrix CameraMotionJacobian(const Vector6d& phi, const Eigen::Matrix3d& R_WC,
                                    const JacobianMatrix& J);

/// J_n of Eq. 8: phi' = J_n [v_WM; w_WM] for a camera at rest in W.
///   [ R_CW  0           ]
///   [ 0     J_c^-1 R_CW ]
/// @throws std::domain_error at theta = +-90 deg.
Eigen::Matrix<double, 6, 6> HeadMotionJacobian(const Vector6d& phi, const Eigen::Matrix3d& R_WC);

/// phi' = J_m qdot (Eq. 15) from the camera's twist alone, which is all of q and qdot that J_m qdot
/// depends on: [-R_CW v_WC - (R_CW w_WC) x p_CM; -J_c^-1 R_CW w_WC].
/// @throws std::domain_error at theta = +-90 deg.
Vector6d PhiRate(const Vector6d& phi, const Eigen::Matrix3d& R_WC, const CameraTwist& camera);

/// Eq. 16, one Euler step: phi + dt_s phi'. R_WC and twist are those of the earlier exposure.
/// @throws std::domain_error at theta = +-90 deg.
Vector6d EulerStep(const Vector6d& phi, const Eigen::Matrix3d& R_WC, const CameraTwist& camera,
                   double dt_s);

/// EulerStep() of every column; the same numbers.
/// @throws std::domain_error naming the individual at theta = +-90 deg; then none is changed.
void EulerStepAll(const Eigen::Matrix3d& R_WC, const CameraTwist& camera, double dt_s,
                  Eigen::Ref<Matrix6Xd> population);

/// X_C2C1 = X_C2W X_WC1: the earlier camera seen from the later one.
RigidTransform CameraDisplacement(const RigidTransform& X_WC1, const RigidTransform& X_WC2);

/// Exact feedforward of a head at rest: phi of X_C2M = X_C2C1 X_C1M. Angles come back with
/// |theta| <= 90 deg.
Vector6d Carry(const RigidTransform& X_C2C1, const Vector6d& phi);

/// Carry() of every column; the same numbers.
void CarryAll(const RigidTransform& X_C2C1, Eigen::Ref<Matrix6Xd> population);

}  // namespace visavis
