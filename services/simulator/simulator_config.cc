#include "services/simulator/simulator_config.h"

#include <filesystem>

#include "common/config/config_error.h"
#include "common/rigs/rig_file.h"

namespace visavis {

void SimulatorConfig::ValidateOrThrow() const {
  RequireRigFile(rig_file);
  if (!scene.mesh_file.empty() && !std::filesystem::is_regular_file(scene.mesh_file)) {
    throw FieldError("scene.mesh_file", scene.mesh_file, "must be a file that exists, or empty");
  }
  scenario.ValidateOrThrow();
  scene.ValidateOrThrow();
  gige.ValidateOrThrow();
  if (cameras != "gige" && !gige.faults.empty()) {
    throw FieldError("gige.faults", "given", "needs cameras: gige");
  }
  if (!export_rig.empty() && !publish_arm) {
    throw FieldError("export_rig", export_rig, "needs publish_arm: the file holds the arm");
  }
  if (arm_rate_hz < frame_rate_hz) {
    throw FieldError("arm_rate_hz", std::to_string(arm_rate_hz), "must not be below frame_rate_hz");
  }
}

}  // namespace visavis
