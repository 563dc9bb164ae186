#include <filesystem>
#include <sstream>

#include "services/stereo_capture/aravis_connection.h"
#include "services/stereo_capture/sources.h"

namespace visavis {
namespace {

constexpr int kListMs = 500;

std::string Names(const char** names, guint count) {
  const GlibPtr<const char*> owner(names);
  std::string text;
  for (guint i = 0; i < count; ++i) text += std::string(i ? " " : "") + names[i];
  return text.empty() ? "none" : text;
}

std::string Supports(const FoundCamera& found) {
  std::ostringstream text;
  try {
    AravisConnection connection(found);
    ArvCamera* camera = connection.camera();
    // Asked by somebody else some cameras take seconds, each for every feature.
    if (!connection.TakeControl()) return "  another program holds it\n";
    guint count = 0;
    const char** formats =
        arv_camera_dup_available_pixel_formats_as_strings(camera, &count, nullptr);
    text << "  pixel_format: " << Names(formats, count) << '\n';
    gint width = 0, height = 0;
    arv_camera_get_sensor_size(camera, &width, &height, nullptr);
    text << "  sensor: " << width << "x" << height << '\n';
    double min = 0, max = 0;
    if (arv_camera_is_frame_rate_available(camera, nullptr)) {
      arv_camera_get_frame_rate_bounds(camera, &min, &max, nullptr);
      text << "  frame_rate_hz: " << min << " to " << max << '\n';
    }
    if (arv_camera_is_exposure_time_available(camera, nullptr)) {
      arv_camera_get_exposure_time_bounds(camera, &min, &max, nullptr);
      text << "  exposure_ms: " << 1e-3 * min << " to " << 1e-3 * max
           << (arv_camera_is_exposure_auto_available(camera, nullptr) ? ", auto" : "") << '\n';
    }
    if (arv_camera_is_gain_available(camera, nullptr)) {
      arv_camera_get_gain_bounds(camera, &min, &max, nullptr);
      text << "  gain_db: " << min << " to " << max
           << (arv_camera_is_gain_auto_available(camera, nullptr) ? ", auto" : "") << '\n';
    }
    text << "  binning: " << (arv_camera_is_binning_available(camera, nullptr) ? "yes" : "no")
         << '\n';
    const char** sources = arv_camera_dup_available_trigger_sources(camera, &count, nullptr);
    text << "  trigger sources: " << Names(sources, count) << '\n';
    const auto has = [&](const char* feature) {
      return arv_camera_is_feature_available(camera, feature, nullptr) ? "yes" : "no";
    };
    text << "  ptp: " << has(has("PtpEnable")[0] == 'y' ? "PtpEnable" : "GevIEEE1588")
         << ", scheduled action: " << has("ActionDeviceKey")
         << ", white balance: " << has("BalanceRatio") << '\n';
  } catch (const std::exception& e) {
    text << "  " << e.what() << '\n';
  }
  return text.str();
}

}  // namespace

std::string ListCameras() {
  std::string text;
  for (const FoundCamera& found : FindCameras("", kListMs, "")) {
    text += found.text();
    if (!found.device.user_name.empty()) text += " called " + found.device.user_name;
    text += '\n' + Supports(found);
  }
  std::error_code none;
  for (const auto& file : std::filesystem::directory_iterator("/dev/v4l/by-id", none))
    text += file.path().string() + " (source: uvc)\n";
  return text.empty() ? "no GigE Vision or USB3 Vision camera answers\n" : text;
}

}  // namespace visavis
