#pragma once

#include <string>
#include <vector>

#include "common/config/rule.h"

namespace visavis {

/// One camera that fails on command, once.
struct CameraFault {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("camera", &camera, OneOf({"left", "right"}));
    a->Visit("fault", &fault, OneOf({"freeze", "die", "mute", "drop", "clock"}));
    a->Visit("at_s", &at_s, InRange(0.0, 1e6, "s"));
    a->Visit("for_s", &for_s, InRange(0.0, 1e6, "s"));
    a->Visit("address", &address);
    a->Visit("frames", &frames, InRange(1, 1'000'000));
    a->Visit("step_s", &step_s, InRange(-1e6, 1e6, "s"));
  }

  std::string camera{"left"};
  std::string fault{"die"};  ///< freeze, die, mute: for for_s; drop: frames; clock: step_s
  double at_s{0};            ///< since the start
  double for_s{0};           ///< 0: for ever
  std::string address;       ///< die: where it returns; empty: where it was
  int frames{1};
  double step_s{0};
};

/// One GigE Vision camera that shows the simulator's pictures.
struct GigeCameraConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("address", &address);
    a->Visit("serial", &serial);
    a->Visit("clock_start_s", &clock_start_s, InRange(0.0, 1e9, "s"));
    a->Visit("drift_ppm", &drift_ppm, InRange(-1000.0, 1000.0, "ppm"));
    a->Visit("lost_packet_share", &lost_packet_share, InRange(0.0, 1.0));
  }

  std::string address;  ///< of this host, dotted
  std::string serial;
  double clock_start_s{0};  ///< what its clock reads at power-on
  double drift_ppm{0};      ///< what its clock gains on the host's
  double lost_packet_share{0};
};

/// Both, and what goes wrong with them.
struct GigeConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("left", &left);
    a->Visit("right", &right);
    a->Visit("faults", &faults);
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  GigeCameraConfig left{"127.0.0.1", "LEFT"};
  GigeCameraConfig right{"127.0.0.2", "RIGHT"};
  std::vector<CameraFault> faults;
};

}  // namespace visavis
