#include "services/stereo_capture/stereo_capture_config.h"

#include <filesystem>
#include <sstream>

#include "common/config/config_error.h"
#include "common/rigs/rig_file.h"

namespace visavis {
namespace {

std::string ToText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

void RequireFile(const char* key, const std::string& file) {
  if (!std::filesystem::exists(file)) throw FieldError(key, file, "must be a file that exists");
}

}  // namespace

void CameraConfig::ValidateOrThrow() const {
  if ((width_px == 0) != (height_px == 0)) {
    throw FieldError("camera.height_px", std::to_string(height_px),
                     "must be 0 as width_px is, or both given");
  }
  if (exposure == "fixed" && 1e-3 * exposure_ms > period_s()) {
    throw FieldError("camera.exposure_ms", ToText(exposure_ms),
                     "must be at most the period, " + ToText(1e3 * period_s()) + " ms");
  }
  if (packet_size_bytes != 0 && packet_size_bytes < 220) {
    throw FieldError("camera.packet_size_bytes", std::to_string(packet_size_bytes),
                     "must be 0 or at least 220");
  }
  if (trigger == "line" && trigger_line.empty())
    throw FieldError("camera.trigger_line", "''", "must name the line");
  if (trigger == "action" && !ptp)
    throw FieldError("camera.ptp", "false", "must be true for trigger: action");
  if (fourcc.size() != 4) throw FieldError("camera.fourcc", fourcc, "must have four letters");
}

void StereoCaptureConfig::ValidateOrThrow() const {
  camera.ValidateOrThrow();
  const double half_period_ms = 500 * camera.period_s();
  if (tolerance_ms >= half_period_ms) {
    throw FieldError("tolerance_ms", ToText(tolerance_ms),
                     "must be below half a period, " + ToText(half_period_ms) +
                         " ms, or neighbours would pass for a pair");
  }
  RequireRigFile(rig_file);
  if (source == "folder") {
    RequireFile("folder", folder.empty() ? "''" : folder);
    return;
  }
  if (left.device.empty()) throw FieldError("left.device", "''", "must name the left camera");
  if (right.device.empty()) throw FieldError("right.device", "''", "must name the right camera");
  if (left.device == right.device)
    throw FieldError("left.device", left.device, "must be another camera than right.device");
}

}  // namespace visavis
