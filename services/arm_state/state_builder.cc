#include "services/arm_state/state_builder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace visavis {
namespace {

constexpr std::int64_t kNewSessionUs = 1'000'000;

}  // namespace

StateBuilder::StateBuilder(std::vector<ArmJoint> joints, const StateOptions& options)
    : joints_(std::move(joints)),
      options_(options),
      jump_(joints_, options.jump),
      velocity_(options.velocity_window_s),
      columns_(joints_.size(), 0) {
  const auto n = static_cast<Eigen::Index>(joints_.size());
  sample_.q = sample_.qdot = JointVector::Zero(n);
  const std::vector<std::string>& names = options_.joint_names;
  if (names.empty()) return;
  JointReading reading;
  reading.names = names;
  reading.position.assign(names.size(), 0);
  if (!FindJoints(reading)) throw std::invalid_argument("joint_names: " + refusal_);
}

const ArmSample* StateBuilder::Refuse(std::int64_t* counter) {
  ++*counter;
  return nullptr;
}

bool StateBuilder::FindJoints(const JointReading& reading) {
  const std::vector<std::string>& names =
      reading.names.empty() ? options_.joint_names : reading.names;
  const std::size_t n = reading.position.size();
  const std::size_t expected = names.empty() ? joints_.size() : names.size();
  if (n != expected || (!reading.velocity.empty() && reading.velocity.size() != n)) {
    refusal_ = std::to_string(n) + " positions and " + std::to_string(reading.velocity.size()) +
               " velocities: must be " + std::to_string(expected) + " each, for as many joints";
    return false;
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (names.empty()) {
      columns_[i] = static_cast<int>(i);
      continue;
    }
    const auto found = std::find(names.begin(), names.end(), joints_[i].name);
    const bool twice =
        found != names.end() && std::find(found + 1, names.end(), joints_[i].name) != names.end();
    if (found == names.end() || twice) {
      refusal_ = "joint '" + joints_[i].name + "' of the URDF: is " + (twice ? "twice" : "not") +
                 " among the source's joints: must be there once";
      return false;
    }
    columns_[i] = static_cast<int>(found - names.begin());
  }
  return true;
}

bool StateBuilder::IsFinite() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (std::isfinite(sample_.q[static_cast<Eigen::Index>(i)])) continue;
    refusal_ = "position of '" + joints_[i].name + "': not finite: must be a number";
    return false;
  }
  return true;
}

void StateBuilder::BeginSession() {
  ++counts_.sessions;
  jump_.Reset();
  velocity_.Reset();
  clock_.Reset();
  last_us_ = -1;
}

bool StateBuilder::IsInOrder(std::int64_t utime_us) {
  if (utime_us >= 0 && utime_us < last_us_ - kNewSessionUs) BeginSession();
  if (utime_us >= 0 && utime_us > last_us_) return true;
  refusal_ = "utime: " + std::to_string(utime_us) +
             (utime_us < 0 ? ": must be >= 0"
                           : ": must be later than the last one's " + std::to_string(last_us_));
  return false;
}

bool StateBuilder::SetVelocity(const JointReading& reading) {
  const auto estimate = velocity_.Add(reading.utime_us, sample_.q);
  bool known = !options_.differentiate && !reading.velocity.empty();
  for (std::size_t i = 0; known && i < joints_.size(); ++i) {
    const double velocity = reading.velocity[static_cast<std::size_t>(columns_[i])];
    sample_.qdot[static_cast<Eigen::Index>(i)] = velocity;
    known = std::isfinite(velocity);
  }
  if (known) {
    if (!jump_.AreSpeedsPossible(sample_.qdot)) refusal_ = jump_.refusal();
    return refusal_.empty();
  }
  ++counts_.differentiated;
  if (estimate) sample_.qdot = *estimate;
  return estimate.has_value();
}

const ArmSample* StateBuilder::Add(const JointReading& reading, std::int64_t arrival_us) {
  refusal_.clear();
  if (!FindJoints(reading)) return Refuse(&counts_.wrong_joints);
  for (std::size_t i = 0; i < joints_.size(); ++i)
    sample_.q[static_cast<Eigen::Index>(i)] =
        reading.position[static_cast<std::size_t>(columns_[i])];
  if (!IsFinite()) return Refuse(&counts_.not_finite);
  if (!IsInOrder(reading.utime_us)) return Refuse(&counts_.wrong_time);
  switch (jump_.Judge(reading.utime_us, sample_.q)) {
    case JumpCheck::Verdict::kRefused:
      refusal_ = jump_.refusal();
      return Refuse(&counts_.impossible);
    case JumpCheck::Verdict::kJumpFollowed:
      ++counts_.jumps_followed;
      velocity_.Reset();
      break;
    case JumpCheck::Verdict::kPossible:
      break;
  }
  const std::int64_t interval_us = last_us_ < 0 ? 0 : reading.utime_us - last_us_;
  if (interval_us > options_.max_gap_us) {
    ++counts_.gaps;
    counts_.largest_gap_us = std::max(counts_.largest_gap_us, interval_us);
    velocity_.Reset();
  }
  last_us_ = reading.utime_us;
  if (!SetVelocity(reading)) return refusal_.empty() ? nullptr : Refuse(&counts_.impossible);
  sample_.utime_us =
      options_.map_times ? clock_.Map(reading.utime_us, arrival_us) : reading.utime_us;
  return &sample_;
}

}  // namespace visavis
