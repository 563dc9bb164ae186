#include "common/kinematics/feedforward.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "common/core/check.h"

namespace visavis {
namespace {

/// Where AngleRatesFromAngularVelocity() refuses.
bool IsSingular(double theta) { return std::abs(std::cos(theta)) < 1e-6; }

/// phi' of a head at rest, from the camera's twist expressed in C.
Vector6d PhiRateFromTwistInCamera(const Vector6d& phi, const Eigen::Vector3d& v_C,
                                  const Eigen::Vector3d& w_C) {
  Vector6d rate;
  rate.head<3>() = -v_C - w_C.cross(phi.head<3>());
  rate.tail<3>() = -(AngleRatesFromAngularVelocity(phi.tail<3>()) * w_C);
  return rate;
}

}  // namespace

Eigen::Vector3d PositionInCamera(const RigidTransform& X_WC, const Eigen::Vector3d& p_WM) {
  return X_WC.linear().transpose() * (p_WM - X_WC.translation());
}

Eigen::Vector3d VelocityInCamera(const RigidTransform& X_WC, const CameraTwist& camera,
                                 const Eigen::Vector3d& p_WM, const Eigen::Vector3d& v_WM) {
  return X_WC.linear().transpose() * (v_WM - camera.v_WC) +
         WorldRotationInCamera(X_WC.linear(), camera.w_WC) * PositionInCamera(X_WC, p_WM);
}

Eigen::Vector3d AngularVelocityInCamera(const Eigen::Matrix3d& R_WC, const Eigen::Vector3d& w_WC,
                                        const Eigen::Vector3d& w_WM) {
  return R_WC.transpose() * (w_WM - w_WC);
}

CameraTwist TwistFromJoints(const JacobianMatrix& J,
                            const Eigen::Ref<const Eigen::VectorXd>& qdot) {
  VISAVIS_THROW_UNLESS(qdot.size() == J.cols(), qdot.size());
  CameraTwist camera;
  for (int i = 0; i < J.cols(); ++i) {
    camera.v_WC += J.col(i).head<3>() * qdot[i];
    camera.w_WC += J.col(i).tail<3>() * qdot[i];
  }
  return camera;
}

CameraTwist TwistBetween(const RigidTransform& X_WC1, const RigidTransform& X_WC2, double dt_s) {
  VISAVIS_THROW_UNLESS(dt_s > 0, dt_s);
  const Eigen::Matrix3d R_12_W = X_WC2.linear() * X_WC1.linear().transpose();
  return {(X_WC2.translation() - X_WC1.translation()) / dt_s, LogRotation(R_12_W) / dt_s};
}

Eigen::Matrix3d WorldRotationInCamera(const Eigen::Matrix3d& R_WC, const Eigen::Vector3d& w_WC) {
  return -R_WC.transpose() * Skew(w_WC) * R_WC;
}

JacobianMatrix CameraMotionJacobian(const Vector6d& phi, const Eigen::Matrix3d& R_WC,
                                    const JacobianMatrix& J) {
  const Eigen::Matrix3d R_CW = R_WC.transpose();
  const Eigen::Matrix3d p_cross = R_CW * Skew(R_WC * phi.head<3>());
  const Eigen::Matrix3d Jc_inverse_R_CW = AngleRatesFromAngularVelocity(phi.tail<3>()) * R_CW;
  JacobianMatrix Jm(6, J.cols());
  for (int i = 0; i < J.cols(); ++i) {
    const Eigen::Vector3d Jp = J.col(i).head<3>(), Jo = J.col(i).tail<3>();
    Jm.col(i).head<3>() = -R_CW * Jp + p_cross * Jo;
    Jm.col(i).tail<3>() = -Jc_inverse_R_CW * Jo;
  }
  return Jm;
}

Eigen::Matrix<double, 6, 6> HeadMotionJacobian(const Vector6d& phi, const Eigen::Matrix3d& R_WC) {
  Eigen::Matrix<double, 6, 6> Jn = Eigen::Matrix<double, 6, 6>::Zero();
  Jn.topLeftCorner<3, 3>() = R_WC.transpose();
  Jn.bottomRightCorner<3, 3>() = AngleRatesFromAngularVelocity(phi.tail<3>()) * R_WC.transpose();
  return Jn;
}

Vector6d PhiRate(const Vector6d& phi, const Eigen::Matrix3d& R_WC, const CameraTwist& camera) {
  return PhiRateFromTwistInCamera(phi, R_WC.transpose() * camera.v_WC,
                                  R_WC.transpose() * camera.w_WC);
}

Vector6d EulerStep(const Vector6d& phi, const Eigen::Matrix3d& R_WC, const CameraTwist& camera,
                   double dt_s) {
  return phi + dt_s * PhiRate(phi, R_WC, camera);
}

void EulerStepAll(const Eigen::Matrix3d& R_WC, const CameraTwist& camera, double dt_s,
                  Eigen::Ref<Matrix6Xd> population) {
  for (Eigen::Index i = 0; i < population.cols(); ++i) {
    if (IsSingular(population(4, i))) {
      throw std::domain_error("individual " + std::to_string(i) + ": theta = " +
                              std::to_string(population(4, i)) + " rad, must stay off +-pi/2");
    }
  }
  const Eigen::Vector3d v_C = R_WC.transpose() * camera.v_WC;
  const Eigen::Vector3d w_C = R_WC.transpose() * camera.w_WC;
  for (Eigen::Index i = 0; i < population.cols(); ++i) {
    const Vector6d phi = population.col(i);
    population.col(i) = phi + dt_s * PhiRateFromTwistInCamera(phi, v_C, w_C);
  }
}

RigidTransform CameraDisplacement(const RigidTransform& X_WC1, const RigidTransform& X_WC2) {
  return X_WC2.inverse() * X_WC1;
}

Vector6d Carry(const RigidTransform& X_C2C1, const Vector6d& phi) {
  return PhiFromTransform(X_C2C1 * TransformFromPhi(phi));
}

void CarryAll(const RigidTransform& X_C2C1, Eigen::Ref<Matrix6Xd> population) {
  for (Eigen::Index i = 0; i < population.cols(); ++i) {
    population.col(i) = Carry(X_C2C1, population.col(i));
  }
}

}  // namespace visavis
