#include "services/stereo_capture/picture_source.h"

#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/core/clock.h"
#include "services/stereo_capture/picture_format.h"

namespace visavis {

PictureSource::PictureSource(const StereoCaptureConfig& config,
                             std::unique_ptr<PictureReader> reader,
                             const std::array<std::optional<PictureSize>, 2>& rig_sizes,
                             FrameQueue* queue)
    : config_(config), reader_(std::move(reader)), rig_sizes_(rig_sizes), queue_(*queue) {
  if (!IsPictureFormat(config_.camera.pixel_format)) {
    throw std::invalid_argument(
        "camera.pixel_format: " + config_.camera.pixel_format +
        ": must be keep, Mono8, RGB8 or BGR8 for source: " + config_.source);
  }
  try {
    if (!Read()) throw std::invalid_argument("source: " + config_.source + ": has no pictures");
  } catch (const std::runtime_error& e) {
    throw std::invalid_argument(e.what());
  }
  report_.state = CameraReport::State::kStreaming;
  report_.connects = 1;
  report_.what = config_.source;
  thread_ = std::thread([this] { Run(); });
}

PictureSource::~PictureSource() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  if (thread_.joinable()) thread_.join();
}

CameraReport PictureSource::Report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

bool PictureSource::Read() {
  cv::Mat left, right;
  if (!reader_->Next(&left, &right)) {
    if (!config_.loop) return false;
    reader_->Rewind();
    if (!reader_->Next(&left, &right)) return false;
  }
  left_ = ToFrame(left, config_.camera.pixel_format, Side::kLeft);
  right_ = ToFrame(right, config_.camera.pixel_format, Side::kRight);
  RequireRigSize(left_);
  RequireRigSize(right_);
  return true;
}

void PictureSource::RequireRigSize(const CapturedFrame& frame) const {
  const auto& size = rig_sizes_[Index(frame.side)];
  if (!size || (size->width == frame.image.width && size->height == frame.image.height)) return;
  throw std::invalid_argument("rig_file: " + ToText(*size) + ": the " + SideName(frame.side) +
                              " picture is " + ToText({frame.image.width, frame.image.height}));
}

void PictureSource::Run() {
  const SystemClock clock;
  const std::int64_t start_us = clock.NowUs();
  bool has_pair = true;
  for (std::uint64_t n = 0;; ++n) {
    const auto utime_us =
        start_us + std::llround(1e6 * config_.camera.period_s() * static_cast<double>(n));
    {
      std::unique_lock<std::mutex> lock(mutex_);
      const auto wait = std::chrono::microseconds(utime_us - clock.NowUs());
      if (stopping_.wait_for(lock, wait, [this] { return stop_; })) return;
      // A disk too slow for the rate leaves instants out, as a camera would.
      if (wait < -std::chrono::duration<double>(config_.camera.period_s())) continue;
      if (has_pair) ++report_.frames;
    }
    if (has_pair) {
      for (CapturedFrame* frame : {&left_, &right_}) {
        frame->id = n;
        frame->is_host_time = true;
        frame->device_ns = 1000 * utime_us;
        frame->arrival_us = utime_us;
        queue_.Push(std::move(*frame));
      }
    }
    try {
      has_pair = Read();
      if (!has_pair) break;
    } catch (const std::exception& e) {
      has_pair = false;
      const std::lock_guard<std::mutex> lock(mutex_);
      ++report_.bad_frames;
      report_.last_error = e.what();
    }
  }
  finished_ = true;
}

}  // namespace visavis
