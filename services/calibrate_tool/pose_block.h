#pragma once

// For the solvers alone: a pose as six numbers, rotation vector [rad] over position [m].

#include <ceres/rotation.h>

#include <cmath>

#include "common/geometry/rigid_transform.h"

namespace visavis {

using PoseBlock = Eigen::Matrix<double, 6, 1>;

inline PoseBlock BlockOf(const RigidTransform& X) {
  PoseBlock block;
  block << LogRotation(X.linear()), X.translation();
  return block;
}

inline RigidTransform TransformOf(const PoseBlock& block) {
  return MakeTransform(ExpRotation(block.head<3>()), block.tail<3>());
}

/// Jr with exp(r + dr) = exp(r) exp(Jr dr) to first order: what a change of a rotation vector
/// turns, about the turned axes.
inline Eigen::Matrix3d RightJacobian(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  if (angle < 1e-6) return Eigen::Matrix3d::Identity() - 0.5 * Skew(r);
  const Eigen::Matrix3d K = Skew(r / angle);
  return Eigen::Matrix3d::Identity() - (1 - std::cos(angle)) / angle * K +
         (1 - std::sin(angle) / angle) * K * K;
}

/// X p.
template <typename T>
Eigen::Matrix<T, 3, 1> Apply(const T* block, const Eigen::Matrix<T, 3, 1>& p) {
  Eigen::Matrix<T, 3, 1> result;
  ceres::AngleAxisRotatePoint(block, p.data(), result.data());
  for (int i = 0; i < 3; ++i) result[i] += block[3 + i];
  return result;
}

/// X^-1 p.
template <typename T>
Eigen::Matrix<T, 3, 1> ApplyInverse(const T* block, const Eigen::Matrix<T, 3, 1>& p) {
  const T back[3] = {-block[0], -block[1], -block[2]};
  Eigen::Matrix<T, 3, 1> moved, result;
  for (int i = 0; i < 3; ++i) moved[i] = p[i] - block[3 + i];
  ceres::AngleAxisRotatePoint(back, moved.data(), result.data());
  return result;
}

}  // namespace visavis
