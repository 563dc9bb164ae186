#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/kinematics/arm.h"
#include "common/kinematics/joint_history.h"
#include "common/rigs/rig_description.h"
#include "services/calibrate_tool/hand_eye_solver.h"
#include "visavis/arm_state_t.hpp"

namespace visavis {

/// Where the arm was when each view was taken.
class ArmPostures {
 public:
  /// @param capacity  states kept; the oldest go
  /// @throws std::invalid_argument for an arm that cannot be used.
  ArmPostures(const ArmDescription& arm, int capacity);

  void Add(const arm_state_t& state);

  struct Matched {
    std::vector<ArmView> views;
    int num_unknown{0};  ///< left out: no arm state at their time
    int num_moving{0};   ///< left out: a joint moved faster than allowed
  };
  /// @param max_speed  [rad/s or m/s]
  Matched Match(const std::vector<StereoView>& views, double max_speed) const;

  /// Why the last state was refused; empty: none was.
  std::string last_refusal() const { return joints_.DescribeLastRejection(); }
  std::int64_t num_states() const { return joints_.counts().accepted; }

 private:
  const Arm arm_;
  JointHistory joints_;
};

}  // namespace visavis
