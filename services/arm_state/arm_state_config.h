#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "services/arm_state/state_builder.h"

namespace visavis {

/// Configuration of the arm state service; see arm_state.yaml.
struct ArmStateConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("source", &source, SourceName());
    a->Visit("channel", &channel, ChannelPrefix());
    a->VisitFile("csv_file", &csv_file);
    a->VisitFile("rig_file", &rig_file);
    a->Visit("joint_names", &joint_names);
    a->Visit("times", &times, OneOf({"host", "mapped"}));
    a->Visit("velocities", &velocities, OneOf({"source", "differentiated"}));
    a->Visit("velocity_window_ms", &velocity_window_ms, InRange(1.0, 1000.0, "ms"));
    a->Visit("speed_factor", &speed_factor, InRange(0.1, 1000.0));
    a->Visit("beyond_limits_rad", &beyond_limits_rad, InRange(0.0, 1000.0, "rad (or m)"));
    a->Visit("follow_jump_after", &follow_jump_after, InRange(1, 100'000, "readings"));
    a->Visit("max_gap_ms", &max_gap_ms, InRange(1.0, 10'000.0, "ms"));
    a->Visit("min_rate_hz", &min_rate_hz, InRange(0.0, 1000.0, "Hz"));
    a->Visit("arm_state", &arm_state, ChannelName());
    a->Visit("stereo_rig", &stereo_rig, ChannelName());
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  /// One of the kinds of sources.
  static Rule<std::string> SourceName();
  /// Where the source listens; empty: nowhere.
  std::string SourceChannel() const;
  StateOptions States() const;

  std::string source{"simulator"};
  std::string channel;   ///< empty: the source's usual one
  std::string csv_file;  ///< of source csv
  std::string rig_file;  ///< rig.yaml with an arm; empty: the arm of STEREO_RIG
  std::vector<std::string> joint_names;
  std::string times{"host"};
  std::string velocities{"source"};
  double velocity_window_ms{40};
  double speed_factor{1.5};
  double beyond_limits_rad{0.05};
  int follow_jump_after{20};
  double max_gap_ms{50};
  double min_rate_hz{50};
  std::string arm_state{"ARM_STATE"};
  std::string stereo_rig{"STEREO_RIG"};
};

}  // namespace visavis
