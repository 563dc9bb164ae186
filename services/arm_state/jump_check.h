#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/kinematics/arm.h"

namespace visavis {

struct JumpOptions {
  double speed_factor{1.5};    ///< joints may be so much faster than their URDF says, > 0
  double time_slack_s{0.005};  ///< stamps may be off by so much, >= 0
  double slack{0.002};         ///< and positions [rad or m], >= 0
  double beyond_limits{0.05};  ///< position may lie so far outside the URDF's limits [rad or m]
  int follow_after{20};        ///< so many refused in a row that agree with each other: the arm is
                               ///< there, >= 1
};

/// Refuses what the arm cannot do: positions outside its joints' limits, and ways that its joints
/// cannot have gone since the last good reading.
class JumpCheck {
 public:
  enum class Verdict { kPossible, kJumpFollowed, kRefused };

  JumpCheck(std::vector<ArmJoint> joints, const JumpOptions& options);

  /// Judges positions at @p utime_us, later than all before. kJumpFollowed: the last `follow_after`
  /// agree with each other, so the arm is where they say, however it came there.
  Verdict Judge(std::int64_t utime_us, const JointVector& q);

  /// Whether a source's own velocities are possible; else refusal() says why.
  bool AreSpeedsPossible(const JointVector& qdot);

  /// Why the last one was refused: field, value, rule.
  const std::string& refusal() const { return refusal_; }

  /// Forgets all readings: a new session.
  void Reset();

 private:
  struct Reading {
    std::int64_t utime_us{-1};  ///< -1: none
    JointVector q;
  };
  bool IsWithinLimits(const JointVector& q);
  /// Index of the first joint that cannot have come from @p from, or -1.
  int FindJump(const Reading& from, std::int64_t utime_us, const JointVector& q) const;
  double MaxWay(const ArmJoint& joint, double dt_s) const;

  const std::vector<ArmJoint> joints_;
  const JumpOptions options_;
  Reading last_, refused_;
  int num_refused_{0};  ///< in a row that agree
  std::string refusal_;
};

}  // namespace visavis
