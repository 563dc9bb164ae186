#pragma once

#include <Eigen/Geometry>

namespace visavis {

/// X_AB: pose of frame B in frame A, so p_A = X_AB * p_B. Metres.
using RigidTransform = Eigen::Isometry3d;

/// X_AB from the position of B's origin in A [m] and a rotation.
inline RigidTransform MakeTransform(const Eigen::Matrix3d& R_AB, const Eigen::Vector3d& p_AB) {
  RigidTransform X_AB = RigidTransform::Identity();
  X_AB.linear() = R_AB;
  X_AB.translation() = p_AB;
  return X_AB;
}

inline RigidTransform MakeTransform(const Eigen::Quaterniond& q_AB, const Eigen::Vector3d& p_AB) {
  return MakeTransform(q_AB.normalized().toRotationMatrix(), p_AB);
}

/// Unit quaternion of the rotation, with w >= 0 so that equal rotations give equal numbers.
Eigen::Quaterniond CanonicalQuaternion(const Eigen::Matrix3d& R);

/// Rotation by the rotation vector @p r [rad] (exponential map); exact at zero.
Eigen::Matrix3d ExpRotation(const Eigen::Vector3d& r);

/// Rotation vector [rad] of @p R (logarithm), angle in [0, pi].
Eigen::Vector3d LogRotation(const Eigen::Matrix3d& R);

/// Matrix [v x] with [v x] u = v.cross(u).
Eigen::Matrix3d Skew(const Eigen::Vector3d& v);

/// Pose between @p X_0 and @p X_1 at @p s (0: X_0, 1: X_1; beyond: extrapolated): position linear,
/// rotation along the shortest arc.
RigidTransform Interpolate(const RigidTransform& X_0, const RigidTransform& X_1, double s);

}  // namespace visavis
