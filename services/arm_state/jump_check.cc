#include "services/arm_state/jump_check.h"

#include <cmath>
#include <sstream>
#include <utility>

namespace visavis {
namespace {

template <typename... Part>
std::string Text(const Part&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

}  // namespace

JumpCheck::JumpCheck(std::vector<ArmJoint> joints, const JumpOptions& options)
    : joints_(std::move(joints)), options_(options) {}

void JumpCheck::Reset() {
  last_.utime_us = refused_.utime_us = -1;
  num_refused_ = 0;
}

double JumpCheck::MaxWay(const ArmJoint& joint, double dt_s) const {
  return options_.speed_factor * joint.max_speed * (dt_s + options_.time_slack_s) + options_.slack;
}

int JumpCheck::FindJump(const Reading& from, std::int64_t utime_us, const JointVector& q) const {
  const double dt_s = 1e-6 * static_cast<double>(utime_us - from.utime_us);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (!(std::abs(q[k] - from.q[k]) <= MaxWay(joints_[i], dt_s))) return static_cast<int>(i);
  }
  return -1;
}

bool JumpCheck::IsWithinLimits(const JointVector& q) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const ArmJoint& joint = joints_[i];
    const double position = q[static_cast<Eigen::Index>(i)];
    if (position >= joint.lower - options_.beyond_limits &&
        position <= joint.upper + options_.beyond_limits)
      continue;
    refusal_ =
        Text("position of '", joint.name, "': ", position, ": must be ", joint.lower, " to ",
             joint.upper, " by the URDF (rad or m), ", options_.beyond_limits, " more at most");
    return false;
  }
  return true;
}

bool JumpCheck::AreSpeedsPossible(const JointVector& qdot) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double speed = qdot[static_cast<Eigen::Index>(i)];
    const double most = options_.speed_factor * joints_[i].max_speed + options_.slack;
    if (std::abs(speed) <= most) continue;
    refusal_ = Text("velocity of '", joints_[i].name, "': ", speed, ": must be at most ", most,
                    " (rad/s or m/s), ", options_.speed_factor, " times the URDF's limit");
    return false;
  }
  return true;
}

JumpCheck::Verdict JumpCheck::Judge(std::int64_t utime_us, const JointVector& q) {
  if (!IsWithinLimits(q)) return Verdict::kRefused;
  const int joint = last_.utime_us < 0 ? -1 : FindJump(last_, utime_us, q);
  if (joint < 0) {
    last_ = {utime_us, q};
    num_refused_ = 0;
    return Verdict::kPossible;
  }
  const bool agrees = num_refused_ > 0 && FindJump(refused_, utime_us, q) < 0;
  num_refused_ = agrees ? num_refused_ + 1 : 1;
  refused_ = {utime_us, q};
  if (num_refused_ >= options_.follow_after) {
    last_ = refused_;
    num_refused_ = 0;
    return Verdict::kJumpFollowed;
  }
  const ArmJoint& arm_joint = joints_[static_cast<std::size_t>(joint)];
  const double dt_s = 1e-6 * static_cast<double>(utime_us - last_.utime_us);
  refusal_ = Text("position of '", arm_joint.name, "': ", q[joint], " after ", last_.q[joint], ": ",
                  dt_s, " s apart it must be within ", MaxWay(arm_joint, dt_s), " (rad or m)");
  return Verdict::kRefused;
}

}  // namespace visavis
