#include "services/stereo_capture/aravis_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <vector>

#include "services/stereo_capture/aravis_error.h"
#include "services/stereo_capture/aravis_trigger.h"

namespace visavis {
namespace {

struct NamedFormat {
  const char* name;
  ArvPixelFormat code;
  PixelFormat format;
};
constexpr std::array<NamedFormat, 7> kFormats{
    {{"Mono8", ARV_PIXEL_FORMAT_MONO_8, PixelFormat::kGray},
     {"RGB8", ARV_PIXEL_FORMAT_RGB_8_PACKED, PixelFormat::kRgb},
     {"BGR8", ARV_PIXEL_FORMAT_BGR_8_PACKED, PixelFormat::kBgr},
     {"BayerBG8", ARV_PIXEL_FORMAT_BAYER_BG_8, PixelFormat::kBayerBggr},
     {"BayerGB8", ARV_PIXEL_FORMAT_BAYER_GB_8, PixelFormat::kBayerGbrg},
     {"BayerGR8", ARV_PIXEL_FORMAT_BAYER_GR_8, PixelFormat::kBayerGrbg},
     {"BayerRG8", ARV_PIXEL_FORMAT_BAYER_RG_8, PixelFormat::kBayerRggb}}};

template <typename T>
std::string KeyValue(const std::string& key, const T& value) {
  std::ostringstream text;
  text << key << ": " << value;
  return text.str();
}

template <typename T>
void RequireRange(const std::string& key, T value, T min, T max, const char* unit) {
  if (value >= min && value <= max) return;
  std::ostringstream text;
  text << key << ": " << value << ": this camera takes " << min << " to " << max << unit;
  throw CameraRefusal(text.str());
}

/// Sets one camera up; each step throws as ApplySettings() does.
class Setup {
 public:
  Setup(ArvCamera* camera, const CameraConfig& config) : camera_(camera), config_(config) {}

  bool Has(const char* feature) {
    GlibError error;
    const bool has = arv_camera_is_feature_available(camera_, feature, error.out());
    return has && !error;
  }

  void Stop() {
    GlibError error;
    arv_camera_stop_acquisition(camera_, error.out());
    ThrowOnError(error, "acquisition");
    arv_camera_set_acquisition_mode(camera_, ARV_ACQUISITION_MODE_CONTINUOUS, error.out());
    ThrowOnError(error, "acquisition mode");
  }

  void SetPixelFormat() {
    if (config_.pixel_format == "keep") return;
    const auto* wanted = std::find_if(kFormats.begin(), kFormats.end(), [&](const NamedFormat& f) {
      return config_.pixel_format == f.name;
    });
    const std::string key_value = KeyValue("camera.pixel_format", config_.pixel_format);
    GlibError error;
    guint count = 0;
    const GlibPtr<gint64> codes(
        arv_camera_dup_available_pixel_formats(camera_, &count, error.out()));
    ThrowOnError(error, key_value);
    if (std::find(codes.get(), codes.get() + count, gint64{wanted->code}) == codes.get() + count) {
      std::string known;
      const GlibPtr<const char*> names(
          arv_camera_dup_available_pixel_formats_as_strings(camera_, &count, nullptr));
      for (guint i = 0; i < count; ++i) known += std::string(" ") + names.get()[i];
      throw CameraRefusal(key_value + ": this camera has" + known);
    }
    arv_camera_set_pixel_format(camera_, wanted->code, error.out());
    ThrowOnError(error, key_value);
  }

  void SetRegion() {
    GlibError error;
    if (config_.binning > 0) {
      const std::string key_value = KeyValue("camera.binning", config_.binning);
      if (arv_camera_is_binning_available(camera_, nullptr)) {
        arv_camera_set_binning(camera_, config_.binning, config_.binning, error.out());
        ThrowOnError(error, key_value);
      } else if (config_.binning > 1) {
        throw CameraRefusal(key_value + ": this camera has no binning");
      }
    }
    if (config_.width_px == 0) return;
    arv_camera_set_region(camera_, 0, 0, -1, -1, error.out());  // or the region could not grow
    ThrowOnError(error, "camera.offset_x_px: 0");
    gint min = 0, max = 0;
    arv_camera_get_width_bounds(camera_, &min, &max, error.out());
    ThrowOnError(error, KeyValue("camera.width_px", config_.width_px));
    RequireRange("camera.width_px", config_.width_px, min, max, " px");
    arv_camera_get_height_bounds(camera_, &min, &max, error.out());
    ThrowOnError(error, KeyValue("camera.height_px", config_.height_px));
    RequireRange("camera.height_px", config_.height_px, min, max, " px");
    arv_camera_set_region(camera_, config_.offset_x_px, config_.offset_y_px, config_.width_px,
                          config_.height_px, error.out());
    ThrowOnError(error, KeyValue("camera.width_px", config_.width_px));
  }

  void SetExposure() {
    GlibError error;
    if (config_.exposure == "keep") return;
    const bool has_auto = arv_camera_is_exposure_auto_available(camera_, nullptr);
    if (config_.exposure == "auto") {
      if (!has_auto) throw CameraRefusal("camera.exposure: auto: this camera has no such thing");
      arv_camera_set_exposure_time_auto(camera_, ARV_AUTO_CONTINUOUS, error.out());
      return ThrowOnError(error, "camera.exposure: auto");
    }
    if (has_auto) arv_camera_set_exposure_time_auto(camera_, ARV_AUTO_OFF, error.out());
    ThrowOnError(error, "camera.exposure: fixed");
    const std::string key_value = KeyValue("camera.exposure_ms", config_.exposure_ms);
    double min = 0, max = 0;
    arv_camera_get_exposure_time_bounds(camera_, &min, &max, error.out());
    ThrowOnError(error, key_value);
    RequireRange("camera.exposure_ms", config_.exposure_ms, 1e-3 * min, 1e-3 * max, " ms");
    arv_camera_set_exposure_time(camera_, 1e3 * config_.exposure_ms, error.out());
    ThrowOnError(error, key_value);
  }

  void SetGain() {
    GlibError error;
    if (config_.gain == "keep") return;
    const bool has_auto = arv_camera_is_gain_auto_available(camera_, nullptr);
    if (config_.gain == "auto") {
      if (!has_auto) throw CameraRefusal("camera.gain: auto: this camera has no such thing");
      arv_camera_set_gain_auto(camera_, ARV_AUTO_CONTINUOUS, error.out());
      return ThrowOnError(error, "camera.gain: auto");
    }
    if (has_auto) arv_camera_set_gain_auto(camera_, ARV_AUTO_OFF, error.out());
    ThrowOnError(error, "camera.gain: fixed");
    const std::string key_value = KeyValue("camera.gain_db", config_.gain_db);
    double min = 0, max = 0;
    arv_camera_get_gain_bounds(camera_, &min, &max, error.out());
    ThrowOnError(error, key_value);
    RequireRange("camera.gain_db", config_.gain_db, min, max, "");
    arv_camera_set_gain(camera_, config_.gain_db, error.out());
    ThrowOnError(error, key_value);
  }

  void SetWhiteBalance() {
    if (config_.white_balance == "keep") return;
    const std::string key_value = "camera.white_balance: " + config_.white_balance;
    const bool is_auto = config_.white_balance == "auto";
    GlibError error;
    if (Has("BalanceWhiteAuto")) {
      arv_camera_set_string(camera_, "BalanceWhiteAuto", is_auto ? "Continuous" : "Off",
                            error.out());
      ThrowOnError(error, key_value);
    } else if (is_auto) {
      throw CameraRefusal(key_value + ": this camera has no BalanceWhiteAuto");
    }
    if (is_auto) return;
    if (!Has("BalanceRatio")) throw CameraRefusal(key_value + ": this camera has no BalanceRatio");
    SetBalanceRatio("Red", "camera.white_balance_red", config_.white_balance_red);
    SetBalanceRatio("Blue", "camera.white_balance_blue", config_.white_balance_blue);
  }

  void SetTiming() {
    GlibError error;
    if (config_.ptp) SetPtp();
    if (config_.trigger == "free") {
      arv_camera_clear_triggers(camera_, error.out());
      ThrowOnError(error, "camera.trigger: free");
      return SetFrameRate();
    }
    const std::string source = config_.trigger == "line"       ? config_.trigger_line
                               : config_.trigger == "software" ? "Software"
                                                               : "Action1";
    const std::string key_value = "camera.trigger: " + config_.trigger;
    if (config_.trigger == "action") SetActionKeys(key_value);
    RequireTriggerSource(key_value, source);
    arv_camera_set_trigger(camera_, source.c_str(), error.out());
    ThrowOnError(error, key_value);
  }

  void SetTransport() {
    if (!arv_camera_is_gv_device(camera_)) return;
    GlibError error;
    const std::string key_value = KeyValue("camera.packet_size_bytes", config_.packet_size_bytes);
    arv_camera_gv_set_packet_size_adjustment(camera_, ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
    arv_camera_gv_set_packet_size(camera_, config_.packet_size_bytes, error.out());
    ThrowOnError(error, key_value);
    if (config_.packet_delay_us > 0) {
      arv_camera_gv_set_packet_delay(camera_, std::llround(1e3 * config_.packet_delay_us),
                                     error.out());
      ThrowOnError(error, KeyValue("camera.packet_delay_us", config_.packet_delay_us));
    }
    arv_camera_gv_set_stream_options(camera_, config_.packet_socket
                                                  ? ARV_GV_STREAM_OPTION_NONE
                                                  : ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }

  void SetFeatures(const std::map<std::string, std::string>& features) {
    for (const auto& [name, value] : features) {
      GlibError error;
      const std::string key_value = "features." + name + ": " + value;
      if (!Has(name.c_str())) throw CameraRefusal(key_value + ": this camera has no such feature");
      arv_device_set_features_from_string(arv_camera_get_device(camera_),
                                          (name + "=" + value).c_str(), error.out());
      ThrowOnError(error, key_value);
    }
  }

  CameraFormat ReadBack() {
    GlibError error;
    CameraFormat result;
    gint x = 0, y = 0;
    arv_camera_get_region(camera_, &x, &y, &result.width, &result.height, error.out());
    ThrowOnError(error, "camera.width_px");
    const ArvPixelFormat code = arv_camera_get_pixel_format(camera_, error.out());
    ThrowOnError(error, "camera.pixel_format");
    const auto* format = std::find_if(kFormats.begin(), kFormats.end(),
                                      [&](const NamedFormat& f) { return f.code == code; });
    if (format == kFormats.end()) {
      const char* name = arv_camera_get_pixel_format_as_string(camera_, nullptr);
      throw CameraRefusal(KeyValue("camera.pixel_format", config_.pixel_format) +
                          ": this camera is set to " + (name ? name : "an unknown one") +
                          ", must be an 8-bit Mono, RGB, BGR or Bayer format");
    }
    result.format = format->format;
    result.code = code;
    result.payload_bytes = arv_camera_get_payload(camera_, error.out());
    ThrowOnError(error, "payload");
    if (result.payload_bytes < result.image_bytes())
      throw CameraLost("payload: " + std::to_string(result.payload_bytes) + " bytes: must be " +
                       std::to_string(result.image_bytes()) + " at least");
    ReadExposure(camera_, &result.exposure_us, &result.gain_db);
    std::ostringstream text;
    text << result.width << "x" << result.height << " " << format->name;
    if (std::isfinite(result.exposure_us)) text << ", " << 1e-3 * result.exposure_us << " ms";
    if (arv_camera_is_gv_device(camera_))
      text << ", packets of " << arv_camera_gv_get_packet_size(camera_, nullptr) << " bytes";
    result.text = text.str();
    return result;
  }

 private:
  void SetBalanceRatio(const char* selector, const char* key, double value) {
    GlibError error;
    arv_camera_set_string(camera_, "BalanceRatioSelector", selector, error.out());
    ThrowOnError(error, KeyValue(key, value));
    arv_camera_set_float(camera_, "BalanceRatio", value, error.out());
    ThrowOnError(error, KeyValue(key, value));
  }

  void SetPtp() {
    GlibError error;
    for (const char* feature : {"PtpEnable", "GevIEEE1588"}) {
      if (!Has(feature)) continue;
      arv_camera_set_boolean(camera_, feature, TRUE, error.out());
      return ThrowOnError(error, "camera.ptp: true");
    }
    throw CameraRefusal("camera.ptp: true: this camera has neither PtpEnable nor GevIEEE1588");
  }

  void SetActionKeys(const std::string& key_value) {
    GlibError error;
    if (Has("ActionSelector")) arv_camera_set_integer(camera_, "ActionSelector", 1, error.out());
    ThrowOnError(error, key_value);
    const std::pair<const char*, std::uint32_t> keys[] = {
        {"ActionDeviceKey", kActionKeys.device_key},
        {"ActionGroupKey", kActionKeys.group_key},
        {"ActionGroupMask", kActionKeys.group_mask}};
    for (const auto& [feature, value] : keys) {
      if (!Has(feature)) throw CameraRefusal(key_value + ": this camera has no " + feature);
      arv_camera_set_integer(camera_, feature, value, error.out());
      ThrowOnError(error, key_value);
    }
  }

  void SetFrameRate() {
    if (!arv_camera_is_frame_rate_available(camera_, nullptr)) return;
    GlibError error;
    const std::string key_value = KeyValue("camera.frame_rate_hz", config_.frame_rate_hz);
    double min = 0, max = 0;
    arv_camera_get_frame_rate_bounds(camera_, &min, &max, error.out());
    ThrowOnError(error, key_value);
    RequireRange("camera.frame_rate_hz", config_.frame_rate_hz, min, max, " Hz");
    arv_camera_set_frame_rate(camera_, config_.frame_rate_hz, error.out());
    ThrowOnError(error, key_value);
    // Exposure or the link may make it slower than asked, without a word.
    const double rate_hz = arv_camera_get_frame_rate(camera_, error.out());
    ThrowOnError(error, key_value);
    if (std::abs(rate_hz - config_.frame_rate_hz) > 0.02 * config_.frame_rate_hz)
      throw CameraRefusal(key_value + ": this camera makes it " + std::to_string(rate_hz));
  }

  void RequireTriggerSource(const std::string& key_value, const std::string& source) {
    guint count = 0;
    GlibError error;
    const GlibPtr<const char*> sources(
        arv_camera_dup_available_trigger_sources(camera_, &count, error.out()));
    ThrowOnError(error, key_value);
    std::string known;
    for (guint i = 0; i < count; ++i) {
      if (source == sources.get()[i]) return;
      known += std::string(" ") + sources.get()[i];
    }
    throw CameraRefusal(key_value + ": needs the trigger source " + source + ", this camera has" +
                        known);
  }

  ArvCamera* const camera_;
  const CameraConfig& config_;
};

}  // namespace

void ThrowOnError(const GlibError& error, const std::string& key_value) {
  if (!error) return;
  if (error.get()->domain == ARV_DEVICE_ERROR) {
    switch (error.get()->code) {
      case ARV_DEVICE_ERROR_NOT_CONNECTED:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR:
      case ARV_DEVICE_ERROR_TRANSFER_ERROR:
      case ARV_DEVICE_ERROR_TIMEOUT:
      case ARV_DEVICE_ERROR_NOT_FOUND:
      case ARV_DEVICE_ERROR_NOT_CONTROLLER:
      case ARV_DEVICE_ERROR_UNKNOWN:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
      case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY:
        throw CameraLost(key_value + ": " + error.message());
      default:
        break;
    }
  }
  throw CameraRefusal(key_value + ": " + error.message());
}

void ReadExposure(ArvCamera* camera, double* exposure_us, double* gain_db) {
  GlibError error;
  *exposure_us = *gain_db = std::nan("");
  if (arv_camera_is_exposure_time_available(camera, nullptr)) {
    *exposure_us = arv_camera_get_exposure_time(camera, error.out());
    ThrowOnError(error, "exposure time");
  }
  if (arv_camera_is_gain_available(camera, nullptr)) {
    *gain_db = arv_camera_get_gain(camera, error.out());
    ThrowOnError(error, "gain");
  }
}

CameraFormat ApplySettings(ArvCamera* camera, const CameraConfig& config,
                           const std::map<std::string, std::string>& features,
                           const std::optional<PictureSize>& rig_size) {
  Setup setup(camera, config);
  setup.Stop();
  setup.SetPixelFormat();
  setup.SetRegion();
  setup.SetExposure();
  setup.SetGain();
  setup.SetWhiteBalance();
  setup.SetTiming();
  setup.SetTransport();
  setup.SetFeatures(features);
  const CameraFormat format = setup.ReadBack();
  const PictureSize size{format.width, format.height};
  if (config.width_px > 0 && (size.width != config.width_px || size.height != config.height_px))
    throw CameraRefusal("camera.width_px: " + ToText({config.width_px, config.height_px}) +
                        ": this camera makes it " + ToText(size));
  if (rig_size && (size.width != rig_size->width || size.height != rig_size->height))
    throw CameraRefusal("rig_file: " + ToText(*rig_size) + ": this camera's pictures are " +
                        ToText(size));
  return format;
}

}  // namespace visavis
