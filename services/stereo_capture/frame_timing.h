#pragma once

#include <cstdint>
#include <optional>

#include "services/stereo_capture/camera_config.h"
#include "services/stereo_capture/clock_map.h"
#include "services/stereo_capture/frame_ids.h"
#include "services/stereo_capture/frame_source.h"

namespace visavis {

/// When one camera's frames were exposed, in host time: its clock mapped, its numbers watched.
class FrameTiming {
 public:
  explicit FrameTiming(const CameraConfig& config);

  /// @return the frame's mid-exposure [us, host time]; nothing while the camera's clock is not
  /// known yet, or where the frame's time makes no sense.
  std::optional<std::int64_t> Add(const CapturedFrame& frame);

  /// Whether the last Add() began anew: the camera was away or its clock was set. Frames that wait
  /// for a partner have times of the old clock.
  bool restarted() const { return restarted_; }
  /// By the camera's clock, the middle of the exposure [us].
  std::int64_t CameraMidUs(const CapturedFrame& frame) const;
  double drift_ppm() const { return map_.drift_ppm(); }

  // Frames since start.
  std::int64_t lost() const { return lost_; }        ///< by the camera's numbers
  std::int64_t untimed() const { return untimed_; }  ///< without a host time

 private:
  /// From the time stamp to the middle and the end of the exposure [us].
  double ToMiddle(const CapturedFrame& frame) const;
  double ToEnd(const CapturedFrame& frame) const;

  const double stamp_share_;  // of the exposure that has passed at the time stamp
  const double readout_us_;
  ClockMap map_;
  FrameIds ids_;
  std::int64_t session_{-1}, lost_{0}, untimed_{0};
  bool restarted_{false};
};

}  // namespace visavis
