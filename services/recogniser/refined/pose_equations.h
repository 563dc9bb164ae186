#pragma once

#include <Eigen/Core>

#include "common/geometry/head_angles.h"

namespace visavis {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Normal equations of a Gauss-Newton step about X_CM: unknown [dp; w] in C (m, rad), so that a
/// model point moves by dp + w x (R_CM p_M).
struct PoseEquations {
  Matrix6d H{Matrix6d::Zero()};
  Vector6d g{Vector6d::Zero()};

  /// One measurement: the model point at R_CM p_M = @p arm should move so that
  /// @p slope . movement = @p residual. @p weight: inverse variance.
  void Add(const Eigen::Vector3f& slope, const Eigen::Vector3f& arm, float residual, float weight) {
    float J[6] = {slope.x(), slope.y(), slope.z(), 0, 0, 0};
    Eigen::Map<Eigen::Vector3f>(J + 3) = arm.cross(slope);
    const double w = static_cast<double>(weight);
    for (int i = 0; i < 6; ++i) {
      const double wi = w * static_cast<double>(J[i]);
      for (int j = i; j < 6; ++j) H(j, i) += wi * static_cast<double>(J[j]);
      g[i] += wi * static_cast<double>(residual);
    }
  }
  void AddPrior(double sigma_m, double sigma_rad) {
    H.diagonal().head<3>().array() += 1 / (sigma_m * sigma_m);
    H.diagonal().tail<3>().array() += 1 / (sigma_rad * sigma_rad);
  }
  /// Copies the lower half, which Add() fills, to the upper.
  Matrix6d Full() const { return H.selfadjointView<Eigen::Lower>(); }
};

/// @p X_CM moved by the step [dp; w].
inline RigidTransform Moved(const RigidTransform& X_CM, const Vector6d& step) {
  return MakeTransform((ExpRotation(step.tail<3>()) * X_CM.linear()).eval(),
                       X_CM.translation() + step.head<3>());
}

}  // namespace visavis
