#include "services/simulator/gige_cameras.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "common/gige/gobject.h"

namespace visavis {
namespace {

constexpr int kSensorSize = 2048;  // of Aravis's camera [px]

// A camera that waits answers no client.
constexpr std::chrono::milliseconds kLongestWait{100};

std::uint8_t Luminance(const std::uint8_t* p) {
  return static_cast<std::uint8_t>((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) >> 8);
}

// Which of R, G, B the four pixels of a pattern are: (0, 0), (1, 0), (0, 1), (1, 1).
std::array<int, 4> Pattern(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerBggr:
      return {2, 1, 1, 0};
    case PixelFormat::kBayerGbrg:
      return {1, 2, 0, 1};
    case PixelFormat::kBayerGrbg:
      return {1, 0, 2, 1};
    default:
      return {0, 1, 1, 2};
  }
}

void FillRow(const std::uint8_t* rgb, int y, int width, PixelFormat format, std::uint8_t* out) {
  if (format == PixelFormat::kRgb) {
    std::memcpy(out, rgb, static_cast<std::size_t>(3 * width));
    return;
  }
  const bool gray = format == PixelFormat::kGray;
  const std::array<int, 4> pattern = Pattern(format);
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* p = rgb + 3 * x;
    out[x] = gray ? Luminance(p) : p[pattern[static_cast<std::size_t>(2 * (y & 1) + (x & 1))]];
  }
}

void RequireFits(const char* name, const Pinhole& eye) {
  if (eye.width <= kSensorSize && eye.height <= kSensorSize) return;
  throw std::invalid_argument("rig_file: " + std::string(name) + ": " + std::to_string(eye.width) +
                              " x " + std::to_string(eye.height) +
                              " px: must be at most 2048 x 2048 with cameras: gige");
}

}  // namespace

void FillFrameFromRgb(const std::vector<std::uint8_t>& rgb, int width, int height,
                      const FakeFrame& frame) {
  const int bytes = BytesPerPixel(frame.format);
  const int columns = std::min(width, frame.width), rows = std::min(height, frame.height);
  const auto stride = static_cast<std::size_t>(bytes * frame.width);
  if (columns < frame.width || rows < frame.height) {
    std::memset(frame.pixels, 0, stride * static_cast<std::size_t>(frame.height));
  }
  for (int y = 0; y < rows; ++y) {
    FillRow(rgb.data() + static_cast<std::ptrdiff_t>(3) * width * y, y, columns, frame.format,
            frame.pixels + stride * static_cast<std::size_t>(y));
  }
}

GigeCameras::GigeCameras(const GigeConfig& config, const StereoRig& rig, double frame_rate_hz,
                         double exposure_ms)
    : rig_(rig),
      frame_rate_hz_(frame_rate_hz),
      start_exposure_us_(std::llround(1000 * exposure_ms)),
      period_us_(std::llround(1e6 / frame_rate_hz)),
      exposure_us_(start_exposure_us_) {
  RequireFits("left", rig.left);
  RequireFits("right", rig.right);
  for (const CameraFault& fault : config.faults) faults_.push_back({fault});
  PowerOn(kLeft, config.left, rig.left);
  PowerOn(kRight, config.right, rig.right);
}

GigeCameras::~GigeCameras() {
  const std::lock_guard<std::mutex> lock(mutex_);
  leaving_ = true;
  changed_.notify_all();
}

void GigeCameras::PowerOn(Side side, const GigeCameraConfig& config, const Pinhole& eye) {
  FakeCamera::Options options;
  options.address = config.address;
  options.serial = config.serial;
  options.width = eye.width;
  options.height = eye.height;
  options.frame_rate_hz = frame_rate_hz_;
  options.clock_start_s = config.clock_start_s;
  options.drift_ppm = config.drift_ppm;
  options.lost_packet_share = config.lost_packet_share;
  auto camera = std::make_unique<FakeCamera>(
      options, [this, side](const FakeFrame& frame) { return Fill(side, frame); });
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    cameras_[side] = std::move(camera);
  }
  SetExposure(side);
}

void GigeCameras::SetExposure(Side side) {
  cameras_[side]->WriteRegister(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US,
                                static_cast<std::uint32_t>(start_exposure_us_));
}

std::int64_t GigeCameras::NextTick(std::int64_t utime_us) const {
  return (utime_us / period_us_ + 1) * period_us_;
}

std::shared_ptr<StereoPicture> GigeCameras::Blank() {
  const std::lock_guard<std::mutex> lock(mutex_);  // so what its last reader did has been done
  for (const auto& picture : pool_) {
    if (picture.use_count() == 1) return picture;
  }
  pool_.push_back(std::make_shared<StereoPicture>(rig_));
  return pool_.back();
}

void GigeCameras::Show(std::shared_ptr<const StereoPicture> picture) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::rotate(shown_.begin(), shown_.end() - 1, shown_.end());
  shown_[0] = std::move(picture);
  changed_.notify_all();
}

std::shared_ptr<const StereoPicture> GigeCameras::TakePicture(Side side, std::int64_t tick_us) {
  std::shared_ptr<const StereoPicture> found;
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, kLongestWait, [&] {
    for (const auto& picture : shown_) {
      const bool taken = picture && picture->due_us > sent_us_[side] && picture->due_us <= tick_us;
      if (taken && (!found || picture->due_us > found->due_us)) found = picture;
    }
    // A later one is there: this one never comes.
    return found || leaving_ || (shown_[0] && shown_[0]->due_us > tick_us);
  });
  if (found) {
    sent_us_[side] = found->due_us;
  } else if (!leaving_ && cameras_[side]) {
    ++lost_;
    cameras_[side]->Drop(1);
  }
  return found;
}

std::optional<std::int64_t> GigeCameras::Fill(Side side, const FakeFrame& frame) {
  auto picture = TakePicture(side, frame.utime_us / frame.period_us * frame.period_us);
  if (!picture) return std::nullopt;
  const Pinhole& eye = side == kLeft ? rig_.left : rig_.right;
  FillFrameFromRgb(side == kLeft ? picture->left : picture->right, eye.width, eye.height, frame);
  const std::int64_t exposed_us = picture->exposed_us;
  const std::lock_guard<std::mutex> lock(mutex_);
  picture.reset();
  return exposed_us - std::llround(frame.exposure_us / 2);
}

void GigeCameras::Update(double time_s) {
  for (Fault& fault : faults_) {
    const double end_s = fault.config.at_s + fault.config.for_s;
    if (!fault.begun && time_s >= fault.config.at_s) {
      fault.begun = true;
      Begin(fault.config);
    }
    if (fault.begun && !fault.ended && fault.config.for_s > 0 && time_s >= end_s) {
      fault.ended = true;
      End(fault.config);
    }
  }
  for (const auto& camera : cameras_) {
    if (!camera->powered()) continue;
    const auto period_us =
        camera->ReadRegister(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US);
    if (period_us > 0) period_us_ = period_us;
    exposure_us_ = camera->ReadRegister(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US);
  }
}

void GigeCameras::Begin(const CameraFault& fault) {
  if (fault.fault == "freeze") camera(fault).Freeze();
  if (fault.fault == "die") camera(fault).Die();
  if (fault.fault == "mute") camera(fault).Mute();
  if (fault.fault == "drop") camera(fault).Drop(fault.frames);
  if (fault.fault == "clock") camera(fault).StepClock(fault.step_s);
}

void GigeCameras::End(const CameraFault& fault) {
  if (fault.fault == "freeze") camera(fault).Thaw();
  if (fault.fault == "mute") camera(fault).Unmute();
  if (fault.fault != "die") return;
  camera(fault).Return(fault.address);
  SetExposure(fault.camera == "left" ? kLeft : kRight);
}

std::string GigeCameras::Faults() const {
  std::string text;
  for (const Fault& fault : faults_) {
    const bool lasts = fault.config.fault == "freeze" || fault.config.fault == "die" ||
                       fault.config.fault == "mute";
    if (!lasts || !fault.begun || fault.ended) continue;
    text += (text.empty() ? "" : ", ") + fault.config.camera + ": " + fault.config.fault;
  }
  return text;
}

}  // namespace visavis
