#include "services/stereo_capture/frame_timing.h"

#include <cmath>

namespace visavis {
namespace {

double StampShare(const std::string& timestamp_at) {
  return timestamp_at == "start" ? 0 : timestamp_at == "middle" ? 0.5 : 1;
}

// A camera that does not tell its exposure: the error is half of it, the same for both.
double Exposure(const CapturedFrame& frame) {
  return std::isfinite(frame.exposure_us) ? frame.exposure_us : 0;
}

}  // namespace

FrameTiming::FrameTiming(const CameraConfig& config)
    : stamp_share_(StampShare(config.timestamp_at)), readout_us_(1e3 * config.readout_ms) {}

double FrameTiming::ToMiddle(const CapturedFrame& frame) const {
  return (0.5 - stamp_share_) * Exposure(frame);
}

double FrameTiming::ToEnd(const CapturedFrame& frame) const {
  return (1 - stamp_share_) * Exposure(frame);
}

std::int64_t FrameTiming::CameraMidUs(const CapturedFrame& frame) const {
  if (frame.is_host_time) return frame.device_ns / 1000;
  return std::llround(1e-3 * static_cast<double>(frame.device_ns) + ToMiddle(frame));
}

std::optional<std::int64_t> FrameTiming::Add(const CapturedFrame& frame) {
  restarted_ = frame.session != session_ && session_ >= 0;
  if (frame.session != session_) {
    session_ = frame.session;
    map_.Reset();
    ids_.Reset();
  }
  lost_ += ids_.Add(frame.id);
  if (frame.is_host_time) return frame.device_ns / 1000;

  const auto verdict = map_.Add(frame.device_ns + std::llround(1e3 * (ToEnd(frame) + readout_us_)),
                                frame.arrival_us);
  restarted_ = restarted_ || verdict == ClockMap::Verdict::kRestarted;
  if (verdict == ClockMap::Verdict::kOutlier || !map_.settled()) {
    ++untimed_;
    return std::nullopt;
  }
  return map_.ToHostUs(frame.device_ns + std::llround(1e3 * ToMiddle(frame)));
}

}  // namespace visavis
