#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/config/rule.h"

namespace visavis {

/// Which camera stands on one side, and what is set on it alone.
struct SideConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("device", &device);
    a->Visit("features", &features);
  }

  std::string device;                           ///< serial, name or address; device; pattern
  std::map<std::string, std::string> features;  ///< GenICam features by name, set last, in order
};

/// What both cameras are set to; see stereo_capture.yaml.
struct CameraConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit(
        "pixel_format", &pixel_format,
        OneOf({"keep", "Mono8", "RGB8", "BGR8", "BayerBG8", "BayerGB8", "BayerGR8", "BayerRG8"}));
    a->Visit("width_px", &width_px, InRange(0, 16384, "px"));
    a->Visit("height_px", &height_px, InRange(0, 16384, "px"));
    a->Visit("offset_x_px", &offset_x_px, InRange(0, 16384, "px"));
    a->Visit("offset_y_px", &offset_y_px, InRange(0, 16384, "px"));
    a->Visit("binning", &binning, InRange(0, 16));
    a->Visit("exposure", &exposure, OneOf({"keep", "auto", "fixed"}));
    a->Visit("exposure_ms", &exposure_ms, InRange(0.001, 10'000.0, "ms"));
    a->Visit("gain", &gain, OneOf({"keep", "auto", "fixed"}));
    a->Visit("gain_db", &gain_db, InRange(-100.0, 1000.0, "dB"));
    a->Visit("white_balance", &white_balance, OneOf({"keep", "auto", "fixed"}));
    a->Visit("white_balance_red", &white_balance_red, InRange(0.01, 100.0));
    a->Visit("white_balance_blue", &white_balance_blue, InRange(0.01, 100.0));
    a->Visit("frame_rate_hz", &frame_rate_hz, InRange(0.1, 1000.0, "Hz"));
    a->Visit("trigger", &trigger, OneOf({"free", "line", "software", "action"}));
    a->Visit("trigger_line", &trigger_line);
    a->Visit("ptp", &ptp);
    a->Visit("timestamp_at", &timestamp_at, OneOf({"start", "middle", "end"}));
    a->Visit("readout_ms", &readout_ms, InRange(0.0, 1000.0, "ms"));
    a->Visit("packet_size_bytes", &packet_size_bytes, InRange(0, 16000, "bytes"));
    a->Visit("packet_delay_us", &packet_delay_us, InRange(0.0, 1e6, "us"));
    a->Visit("packet_resend", &packet_resend);
    a->Visit("packet_socket", &packet_socket);
    a->Visit("socket_buffer_bytes", &socket_buffer_bytes, InRange(0, 1 << 30, "bytes"));
    a->Visit("num_buffers", &num_buffers, InRange(3, 1000));
    a->Visit("stall_ms", &stall_ms, InRange(50.0, 60'000.0, "ms"));
    a->Visit("fourcc", &fourcc);
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  double period_s() const { return 1 / frame_rate_hz; }
  /// How long no frame may come before a camera counts as stalled.
  double stall_s() const {
    return 1e-3 * stall_ms > 2.5 * period_s() ? 1e-3 * stall_ms : 2.5 * period_s();
  }

  std::string pixel_format{"RGB8"};
  int width_px{0}, height_px{0};       ///< 0: as the camera is set
  int offset_x_px{0}, offset_y_px{0};  ///< of the region on the sensor
  int binning{0};                      ///< 0: as the camera is set
  std::string exposure{"keep"};
  double exposure_ms{5};
  std::string gain{"keep"};
  double gain_db{0};
  std::string white_balance{"keep"};
  double white_balance_red{1}, white_balance_blue{1};
  double frame_rate_hz{30};
  std::string trigger{"free"};
  std::string trigger_line{"Line0"};
  bool ptp{false};
  std::string timestamp_at{"start"};  ///< what of the exposure the camera's time stamp means
  double readout_ms{0};               ///< exposure's end to the first packet, known to be constant
  int packet_size_bytes{0};           ///< 0: what the interface takes, see AravisCamera
  double packet_delay_us{0};
  bool packet_resend{true};
  bool packet_socket{false};
  int socket_buffer_bytes{4'000'000};
  int num_buffers{12};
  double stall_ms{300};
  std::string fourcc{"MJPG"};  ///< of a UVC camera
};

}  // namespace visavis
