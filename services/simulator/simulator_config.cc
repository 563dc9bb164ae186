#include "services/simulator/simulator_config.h"

#include <algorithm>
#include <filesystem>

#include "common/config/config_error.h"
#include "services/simulator/subject.h"

namespace visavis {

void SimulatorConfig::ValidateOrThrow() const {
  if (!rig_file.empty() && !std::filesystem::exists(rig_file)) {
    throw FieldError("rig_file", rig_file, "must be a file that exists, or empty");
  }
  if (scenario.absent_until_s < scenario.absent_from_s) {
    throw FieldError("scenario.absent_until_s", std::to_string(scenario.absent_until_s),
                     "must not be below scenario.absent_from_s");
  }
  const auto names = SubjectNames();
  if (std::find(names.begin(), names.end(), world.subject) == names.end()) {
    std::string known;
    for (const auto& name : names) known += " " + name;
    throw FieldError("world.subject", world.subject, "must be one of" + known);
  }
  if (arm_rate_hz < frame_rate_hz) {
    throw FieldError("arm_rate_hz", std::to_string(arm_rate_hz), "must not be below frame_rate_hz");
  }
}

}  // namespace visavis
