#include "services/stereo_capture/uvc_camera.h"

#include <cmath>
#include <filesystem>
#include <opencv2/videoio.hpp>
#include <utility>

#include "common/core/clock.h"
#include "services/stereo_capture/camera_error.h"
#include "services/stereo_capture/picture_format.h"

namespace visavis {
namespace {

// V4L2's way to say who chooses the exposure, and its unit.
constexpr double kV4lManualExposure = 1, kV4lAutoExposure = 3, kV4lExposureUnitMs = 0.1;

void Set(cv::VideoCapture* video, int property, double value, const std::string& key_value) {
  if (!video->set(property, value))
    throw CameraRefusal(key_value + ": this camera does not take it");
}

void SetUp(const CameraConfig& config, cv::VideoCapture* video) {
  const std::string& f = config.fourcc;
  Set(video, cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc(f[0], f[1], f[2], f[3]),
      "camera.fourcc: " + f);
  if (config.width_px > 0) {
    Set(video, cv::CAP_PROP_FRAME_WIDTH, config.width_px, "camera.width_px");
    Set(video, cv::CAP_PROP_FRAME_HEIGHT, config.height_px, "camera.height_px");
  }
  Set(video, cv::CAP_PROP_FPS, config.frame_rate_hz, "camera.frame_rate_hz");
  if (config.exposure != "keep") {
    const bool is_auto = config.exposure == "auto";
    Set(video, cv::CAP_PROP_AUTO_EXPOSURE, is_auto ? kV4lAutoExposure : kV4lManualExposure,
        "camera.exposure: " + config.exposure);
    if (!is_auto)
      Set(video, cv::CAP_PROP_EXPOSURE, config.exposure_ms / kV4lExposureUnitMs,
          "camera.exposure_ms: " + std::to_string(config.exposure_ms));
  }
  if (config.gain == "auto") throw CameraRefusal("camera.gain: auto: UVC cameras have no such");
  if (config.gain == "fixed")
    Set(video, cv::CAP_PROP_GAIN, config.gain_db,
        "camera.gain_db: " + std::to_string(config.gain_db));
  if (config.white_balance == "fixed")
    throw CameraRefusal("camera.white_balance: fixed: UVC cameras have no red and blue gain");
  if (config.white_balance == "auto")
    Set(video, cv::CAP_PROP_AUTO_WB, 1, "camera.white_balance: auto");
}

}  // namespace

UvcCamera::UvcCamera(Side side, SideConfig device, CameraConfig config,
                     std::optional<PictureSize> rig_size, FrameQueue* queue)
    : CameraThread(side, std::move(device), std::move(config), rig_size, queue) {
  Begin();
}

UvcCamera::~UvcCamera() { End(); }

double UvcCamera::RunOnce() {
  const std::string key_value = DeviceKeyValue();
  if (!std::filesystem::exists(device_.device)) {
    Fail(State::kSearching, key_value + ": no such device file; waiting for it");
    return 0.1;
  }
  cv::VideoCapture video;
  if (!video.open(device_.device, cv::CAP_V4L2)) {
    Fail(State::kOpening, key_value + ": cannot be opened: no camera, or in use");
    return 0.5;
  }
  SetUp(config_, &video);
  ++session_;
  cv::Mat picture;
  for (std::uint64_t n = 0; !stopping(); ++n) {
    if (!video.read(picture)) {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++report_.stalls;
      report_.state = State::kOpening;
      report_.text = report_.last_error =
          std::string(SideName(side_)) + " camera: no frame comes; opening it anew";
      return 0.1;
    }
    CapturedFrame frame = ToFrame(picture, config_.pixel_format, side_);
    if (rig_size_ &&
        (frame.image.width != rig_size_->width || frame.image.height != rig_size_->height)) {
      throw CameraRefusal("rig_file: " + ToText(*rig_size_) + ": this camera's pictures are " +
                          ToText({frame.image.width, frame.image.height}));
    }
    frame.session = session_;
    frame.id = n;
    frame.arrival_us = SystemClock().NowUs();
    // The driver's time of the frame, on the system's monotonic clock.
    frame.device_ns = std::llround(1e6 * video.get(cv::CAP_PROP_POS_MSEC));
    if (config_.exposure == "fixed") frame.exposure_us = 1e3 * config_.exposure_ms;
    queue_.Push(std::move(frame));
    const std::lock_guard<std::mutex> lock(mutex_);
    if (n == 0) {
      ++report_.connects;
      report_.what = device_.device;
    }
    report_.state = State::kStreaming;
    report_.text.clear();
    ++report_.frames;
  }
  return 0;
}

}  // namespace visavis
