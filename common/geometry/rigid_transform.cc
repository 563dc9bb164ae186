#include "common/geometry/rigid_transform.h"

namespace visavis {

Eigen::Quaterniond CanonicalQuaternion(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

Eigen::Matrix3d ExpRotation(const Eigen::Vector3d& r) {
  const double angle = r.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, r / angle).toRotationMatrix();
}

Eigen::Vector3d LogRotation(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd rotation(CanonicalQuaternion(R));
  return rotation.angle() * rotation.axis();
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

RigidTransform Interpolate(const RigidTransform& X_0, const RigidTransform& X_1, double s) {
  const Eigen::Matrix3d R_01 = X_0.linear().transpose() * X_1.linear();
  return MakeTransform(Eigen::Matrix3d(X_0.linear() * ExpRotation(s * LogRotation(R_01))),
                       X_0.translation() + s * (X_1.translation() - X_0.translation()));
}

}  // namespace visavis
