#include "common/kinematics/pose_history.h"

namespace visavis {
namespace {

/// How far R^T R may be from identity: rounding of quaternions given with 6 decimals passes.
constexpr double kMaxRotationError = 1e-5;

bool IsRotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() <= kMaxRotationError &&
         R.determinant() > 0;
}

}  // namespace

PoseHistory::PoseHistory(const HistoryOptions& options)
    : times_(options),
      poses_(static_cast<std::size_t>(options.capacity), RigidTransform::Identity()) {}

SampleVerdict PoseHistory::Add(std::int64_t utime_us, const RigidTransform& X_WC) {
  SampleVerdict verdict = times_.Judge(utime_us);
  if (!X_WC.matrix().allFinite()) {
    verdict = SampleVerdict::kNotFinite;
  } else if (!IsRotation(X_WC.linear())) {
    verdict = SampleVerdict::kNotRigid;
  }
  counts_.Count(verdict);
  if (verdict != SampleVerdict::kAccepted) {
    rejected_as_ = verdict;
    rejected_us_ = utime_us;
    newest_us_at_rejection_ = times_.newest_us().value_or(0);
    return verdict;
  }
  if (times_.IsRestart(utime_us)) ++counts_.restarts;
  poses_[times_.Push(utime_us)] = X_WC;
  return verdict;
}

std::optional<CameraState> PoseHistory::At(std::int64_t utime_us) const {
  const auto bracket = times_.Find(utime_us);
  if (!bracket) return std::nullopt;
  const RigidTransform& X_0 = poses_[bracket->slot_0];
  const RigidTransform& X_1 = poses_[bracket->slot_1];
  CameraState state{X_0, {}, false, bracket->extrapolated, bracket->age_us};
  if (bracket->slot_0 == bracket->slot_1) return state;
  const auto interval_us = static_cast<double>(bracket->t_1_us - bracket->t_0_us);
  state.twist = TwistBetween(X_0, X_1, interval_us * 1e-6);
  state.has_twist = true;
  if (utime_us == bracket->t_1_us) {
    state.X_WC = X_1;
  } else if (utime_us != bracket->t_0_us) {
    state.X_WC =
        Interpolate(X_0, X_1, static_cast<double>(utime_us - bracket->t_0_us) / interval_us);
  }
  return state;
}

std::string PoseHistory::DescribeLastRejection() const {
  const std::string time = "utime = " + std::to_string(rejected_us_);
  switch (rejected_as_) {
    case SampleVerdict::kAccepted:
      return "";
    case SampleVerdict::kDuplicate:
      return time + " repeats the newest camera pose, must be later";
    case SampleVerdict::kOutOfOrder:
      return time + " is before the newest camera pose's " +
             std::to_string(newest_us_at_rejection_) + ", must be later";
    case SampleVerdict::kNotFinite:
      return "camera pose is not finite at " + time;
    default:
      return "camera pose must have a rotation matrix or unit quaternion, at " + time;
  }
}

}  // namespace visavis
