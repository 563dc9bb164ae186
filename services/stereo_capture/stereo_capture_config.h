#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "common/config/rule.h"
#include "services/stereo_capture/camera_config.h"

namespace visavis {

/// Configuration of the stereo capture; see stereo_capture.yaml.
struct StereoCaptureConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("source", &source, OneOf({"aravis", "uvc", "folder", "video"}));
    a->Visit("left", &left);
    a->Visit("right", &right);
    a->Visit("camera", &camera);
    a->VisitFile("folder", &folder);
    a->Visit("loop", &loop);
    a->Visit("start", &start, OneOf({"wait", "require"}));
    a->Visit("tolerance_ms", &tolerance_ms, InRange(0.0, 5000.0, "ms"));
    a->Visit("single_images", &single_images);
    a->VisitFile("rig_file", &rig_file);
    a->Visit("image_format", &image_format, OneOf({"raw", "jpeg"}));
    a->Visit("jpeg_quality", &jpeg_quality, InRange(1, 100));
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  /// How far mid-exposures of a pair may be apart.
  std::int64_t tolerance_us() const {
    return std::llround(tolerance_ms > 0 ? 1e3 * tolerance_ms : 0.25e6 * camera.period_s());
  }

  std::string source{"aravis"};
  SideConfig left{"LEFT", {}}, right{"RIGHT", {}};
  CameraConfig camera;
  std::string folder;  ///< with frames.csv
  bool loop{true};     ///< pictures and videos begin anew at their end
  std::string start{"wait"};
  double tolerance_ms{0};  ///< 0: a quarter of the period
  bool single_images{true};
  std::string rig_file;  ///< empty: no STEREO_RIG
  std::string image_format{"raw"};
  int jpeg_quality{90};
};

}  // namespace visavis
