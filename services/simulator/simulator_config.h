#pragma once

#include <cstdint>
#include <string>

#include "common/config/rule.h"
#include "services/simulator/gige_config.h"
#include "services/simulator/scenario.h"
#include "services/simulator/simulated_world.h"

namespace visavis {

/// Configuration of the simulator; see simulator.yaml.
struct SimulatorConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("scenario", &scenario);
    a->Visit("scene", &scene);
    a->Visit("sensor", &sensor);
    a->Visit("seed", &seed, InRange<std::int64_t>(0, 1'000'000'000));
    a->Visit("seconds", &seconds, InRange(0.0, 1e6, "s"));
    a->VisitFile("rig_file", &rig_file);
    a->Visit("frame_rate_hz", &frame_rate_hz, InRange(1.0, 200.0, "Hz"));
    a->Visit("arm_rate_hz", &arm_rate_hz, InRange(10.0, 1000.0, "Hz"));
    a->Visit("readout_ms", &readout_ms, InRange(0.0, 100.0, "ms"));
    a->Visit("publish_arm", &publish_arm);
    a->Visit("arm_channel", &arm_channel, ChannelName());
    a->Visit("publish_camera_pose", &publish_camera_pose);
    a->Visit("image_format", &image_format, OneOf({"raw", "gray", "jpeg"}));
    a->Visit("jpeg_quality", &jpeg_quality, InRange(1, 100));
    a->Visit("cameras", &cameras, OneOf({"publish", "gige"}));
    a->Visit("gige", &gige);
    a->Visit("export_mesh", &export_mesh);
    a->Visit("export_rig", &export_rig);
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  ScenarioConfig scenario;
  SceneConfig scene;
  SensorConfig sensor;
  std::int64_t seed{1};  ///< of all that is random: same scenario, same seed, same bytes
  double seconds{0};     ///< how long; 0: until stopped
  std::string rig_file;  ///< rig.yaml with an arm; empty: the demo's
  double frame_rate_hz{30};
  double arm_rate_hz{200};
  double readout_ms{6};                  ///< from mid-exposure to the images on the bus
  bool publish_arm{true};                ///< ARM_STATE, and the arm in STEREO_RIG
  std::string arm_channel{"ARM_STATE"};  ///< SIMULATOR_ARM_STATE: for visavis-arm-state
  bool publish_camera_pose{false};       ///< CAMERA_POSE, one a pair
  std::string image_format{"raw"};
  int jpeg_quality{90};
  std::string cameras{"publish"};  ///< publish: on the bus | gige: as two GigE Vision cameras
  GigeConfig gige;
  std::string export_rig;   ///< rig.yaml for who captures is written there; empty: nowhere
  std::string export_mesh;  ///< the subject's head is written there as OBJ; empty: nowhere
};

}  // namespace visavis
