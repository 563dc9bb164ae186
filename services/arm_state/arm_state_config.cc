#include "services/arm_state/arm_state_config.h"

#include <cmath>
#include <filesystem>

#include "common/config/config_error.h"
#include "common/rigs/rig_file.h"
#include "services/arm_state/sources/source_list.h"

namespace visavis {

Rule<std::string> ArmStateConfig::SourceName() {
  std::vector<std::string> names;
  for (const SourceKind& kind : SourceKinds()) names.emplace_back(kind.name);
  return OneOf(names);
}

std::string ArmStateConfig::SourceChannel() const {
  return channel.empty() ? FindSourceKind(source).channel : channel;
}

void ArmStateConfig::ValidateOrThrow() const {
  const std::string listens = SourceChannel();
  if (source == "csv" && csv_file.empty())
    throw FieldError("csv_file", "empty", "must name a file where source is csv");
  if (source != "csv" && !csv_file.empty())
    throw FieldError("csv_file", csv_file, "must be empty where source is " + source);
  if (source == "csv" && !channel.empty())
    throw FieldError("channel", channel, "must be empty where source is csv");
  if (source == "csv" && times == "mapped")
    throw FieldError("times", times, "must be host where source is csv");
  if (!listens.empty() && (listens == arm_state || listens == stereo_rig))
    throw FieldError("channel", listens, "must differ from arm_state and stereo_rig");
  if (arm_state == stereo_rig)
    throw FieldError("arm_state", arm_state, "must differ from stereo_rig");
  if (joint_names.size() > static_cast<std::size_t>(kMaxArmJoints))
    throw FieldError("joint_names", std::to_string(joint_names.size()) + " names",
                     "must be at most " + std::to_string(kMaxArmJoints));
  if (!csv_file.empty() && !std::filesystem::is_regular_file(csv_file))
    throw FieldError("csv_file", csv_file, "must be a file that exists");
  RequireRigFile(rig_file);
}

StateOptions ArmStateConfig::States() const {
  StateOptions options;
  options.joint_names = joint_names;
  options.map_times = times == "mapped";
  options.differentiate = velocities == "differentiated";
  options.velocity_window_s = 1e-3 * velocity_window_ms;
  options.max_gap_us = std::llround(1e3 * max_gap_ms);
  options.jump.speed_factor = speed_factor;
  options.jump.beyond_limits = beyond_limits_rad;
  options.jump.follow_after = follow_jump_after;
  return options;
}

}  // namespace visavis
