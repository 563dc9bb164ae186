#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/kinematics/arm.h"
#include "services/arm_state/joint_reading.h"
#include "services/arm_state/jump_check.h"
#include "services/arm_state/stamp_map.h"
#include "services/arm_state/velocity_estimator.h"

namespace visavis {

struct StateOptions {
  std::vector<std::string> joint_names;  ///< of sources that name none; empty: the URDF's, in order
  bool map_times{false};                 ///< the source's clock is not the host's
  bool differentiate{false};             ///< even where the source has velocities
  double velocity_window_s{0.04};
  std::int64_t max_gap_us{50'000};  ///< no velocity is taken across a longer one
  JumpOptions jump;
};

/// One checked state of the arm.
struct ArmSample {
  std::int64_t utime_us{0};  ///< in host time
  JointVector q, qdot;       ///< in the URDF's order
};

/// What became of the readings so far.
struct ReadingCounts {
  std::int64_t wrong_joints{0}, not_finite{0}, wrong_time{0}, impossible{0};  // refused
  std::int64_t gaps{0}, largest_gap_us{0};  ///< between good ones, in the source's time
  std::int64_t jumps_followed{0}, sessions{0}, differentiated{0};
  std::int64_t refused() const { return wrong_joints + not_finite + wrong_time + impossible; }
};

/// Makes checked states of an arm from a source's readings: joints by name, times in order and in
/// host time, no impossible ways, velocities.
///
/// A reading whose time is more than a second before the last begins a new session (a log that is
/// played again), and all is forgotten. Add() allocates nothing for a good reading.
class StateBuilder {
 public:
  /// @param joints  of the URDF, base to tip
  /// @throws std::invalid_argument where options.joint_names are not these, in whatever order.
  StateBuilder(std::vector<ArmJoint> joints, const StateOptions& options);

  /// @return the state to publish, aliased until the next call; null: refused (refusal() says why),
  /// or the first of a source without velocities (refusal() is empty).
  const ArmSample* Add(const JointReading& reading, std::int64_t arrival_us);

  const std::string& refusal() const { return refusal_; }
  const ReadingCounts& counts() const { return counts_; }
  const std::vector<ArmJoint>& joints() const { return joints_; }

 private:
  // Each false sets the refusal; SetVelocity() not where there is no velocity yet.
  bool FindJoints(const JointReading& reading);
  bool IsFinite();
  bool IsInOrder(std::int64_t utime_us);
  bool SetVelocity(const JointReading& reading);
  void BeginSession();
  static const ArmSample* Refuse(std::int64_t* counter);

  const std::vector<ArmJoint> joints_;
  const StateOptions options_;
  JumpCheck jump_;
  VelocityEstimator velocity_;
  StampMap clock_;
  std::vector<int> columns_;  ///< of each joint in the reading
  std::int64_t last_us_{-1};  ///< of the last good reading, by the source's clock
  ArmSample sample_;
  std::string refusal_;
  ReadingCounts counts_;
};

}  // namespace visavis
