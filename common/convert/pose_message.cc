#include "common/convert/pose_message.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/convert/message_error.h"
#include "common/geometry/head_angles.h"

namespace visavis {

void WriteQuaternion(const Eigen::Matrix3d& R, double wxyz[4]) {
  const Eigen::Quaterniond q = CanonicalQuaternion(R);
  wxyz[0] = q.w();
  wxyz[1] = q.x();
  wxyz[2] = q.y();
  wxyz[3] = q.z();
}

RigidTransform ReadTransform(const char* field, const double p_m[3], const double q_wxyz[4]) {
  const Eigen::Vector3d p = Eigen::Map<const Eigen::Vector3d>(p_m, 3);
  const Eigen::Quaterniond q(q_wxyz[0], q_wxyz[1], q_wxyz[2], q_wxyz[3]);
  RequireField(p.allFinite() && p.norm() < 1e6, field, p.transpose(),
               "position must be finite and below 1e6 m");
  RequireField(std::abs(q.norm() - 1) <= 1e-3, field,
               Eigen::Map<const Eigen::RowVector4d>(q_wxyz, 4),
               "quaternion must have norm 1 within 0.001");
  return MakeTransform(q, p);
}

RigidTransform FromMessage(const rigid_transform_t& message) {
  RequireField(message.utime >= 0, "rigid_transform_t.utime", message.utime, "must be >= 0");
  return ReadTransform("rigid_transform_t", message.trans, message.quat);
}

rigid_transform_t ToMessage(const RigidTransform& X, std::int64_t utime) {
  rigid_transform_t message{};
  message.utime = utime;
  Eigen::Map<Eigen::Vector3d>(message.trans, 3) = X.translation();
  WriteQuaternion(X.linear(), message.quat);
  return message;
}

bool HasPose(const head_pose_t& message) {
  return std::all_of(message.p_CM_m, message.p_CM_m + 3,
                     [](double v) { return std::isfinite(v); }) &&
         std::all_of(message.q_CM_wxyz, message.q_CM_wxyz + 4,
                     [](double v) { return std::isfinite(v); });
}

RigidTransform FromMessage(const head_pose_t& message) {
  return ReadTransform("head_pose_t", message.p_CM_m, message.q_CM_wxyz);
}

head_pose_t EmptyHeadPose() {
  head_pose_t message{};
  const double nan = std::nan("");
  std::fill(message.p_CM_m, message.p_CM_m + 3, nan);
  std::fill(message.q_CM_wxyz, message.q_CM_wxyz + 4, nan);
  std::fill(message.euler_zyx_CM_rad, message.euler_zyx_CM_rad + 3, nan);
  std::fill(message.covariance, message.covariance + 36, nan);
  std::fill(message.p_WM_m, message.p_WM_m + 3, nan);
  std::fill(message.q_WM_wxyz, message.q_WM_wxyz + 4, nan);
  message.fitness = message.fitness_site = message.fitness_color = message.fitness_feat = nan;
  return message;
}

void SetPose(const RigidTransform& X_CM, head_pose_t* message) {
  Eigen::Map<Eigen::Vector3d>(message->p_CM_m, 3) = X_CM.translation();
  WriteQuaternion(X_CM.linear(), message->q_CM_wxyz);
  Eigen::Map<Eigen::Vector3d>(message->euler_zyx_CM_rad, 3) = AnglesFromRotation(X_CM.linear());
}

void SetWorldPose(const RigidTransform& X_WM, head_pose_t* message) {
  message->has_world_pose = 1;
  Eigen::Map<Eigen::Vector3d>(message->p_WM_m, 3) = X_WM.translation();
  WriteQuaternion(X_WM.linear(), message->q_WM_wxyz);
}

head_pose_t TruthMessage(std::int64_t utime, std::int64_t seq, const RigidTransform* X_CM) {
  head_pose_t message = EmptyHeadPose();
  message.utime = utime;
  message.seq = seq;
  message.status = X_CM ? head_pose_t::STATUS_TRACKING : head_pose_t::STATUS_LOST;
  if (X_CM) SetPose(*X_CM, &message);
  return message;
}

}  // namespace visavis
