#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "common/gige/fake_camera.h"
#include "services/simulator/gige_config.h"

namespace visavis {

/// Both pictures of one instant, RGB without padding.
struct StereoPicture {
  explicit StereoPicture(const StereoRig& rig)
      : right(static_cast<std::size_t>(3 * rig.right.width * rig.right.height)),
        left(static_cast<std::size_t>(3 * rig.left.width * rig.left.height)) {}

  std::vector<std::uint8_t> right, left;
  std::int64_t exposed_us{0};  ///< host time of the exposure's middle
  std::int64_t due_us{0};      ///< when it leaves the cameras: a tick of theirs
};

/// Fills @p frame, whatever its format, with the upper left part of an RGB picture; black beyond.
/// Bayer patterns are sampled from it, grey is its luminance (ITU-R BT.601).
void FillFrameFromRgb(const std::vector<std::uint8_t>& rgb, int width, int height,
                      const FakeFrame& frame);

/// The simulator's pictures as frames of two GigE Vision cameras, which fail on command.
///
/// The cameras run free, as their client set them: they expose at multiples of the period by the
/// host's clock, so both at one instant. A picture that is shown after its tick leaves late, as
/// over a slow link; one that does not come within 0.1 s is a lost frame. The frame is stamped by
/// the camera's own clock so that the middle of the client's exposure is exposed_us. Threads: each
/// camera has one that reads the pictures shown; everything else is the caller's.
class GigeCameras {
 public:
  /// Powers both on. @throws std::runtime_error where an address cannot be had, and
  /// std::invalid_argument for pictures larger than such a camera's sensor.
  GigeCameras(const GigeConfig& config, const StereoRig& rig, double frame_rate_hz,
              double exposure_ms);
  ~GigeCameras();

  /// How long before its tick a picture may be shown.
  std::int64_t longest_ahead_us() const { return 2 * period_us_; }
  /// When the frame after @p utime_us leaves the cameras.
  std::int64_t NextTick(std::int64_t utime_us) const;
  /// Shutter time as the client set it: the exposure ends at the tick.
  std::int64_t exposure_us() const { return exposure_us_; }

  /// A picture of the rig's sizes to be filled, then shown.
  std::shared_ptr<StereoPicture> Blank();
  void Show(std::shared_ptr<const StereoPicture> picture);

  /// Begins and ends the faults that are due, and takes up what the client set.
  /// @param time_s since the start
  /// @throws std::runtime_error where a camera cannot return to its address.
  void Update(double time_s);

  /// Frames that were due before their picture was there.
  std::int64_t num_lost() const { return lost_; }
  /// Text for the status: what is wrong with the cameras now, by our own doing; empty: nothing.
  std::string Faults() const;

 private:
  enum Side { kLeft, kRight };
  struct Fault {
    CameraFault config;
    bool begun{false}, ended{false};
  };

  std::optional<std::int64_t> Fill(Side side, const FakeFrame& frame);
  /// The newest picture due by a tick that this camera has not sent; null: the frame is lost.
  std::shared_ptr<const StereoPicture> TakePicture(Side side, std::int64_t tick_us);
  void PowerOn(Side side, const GigeCameraConfig& config, const Pinhole& eye);
  void SetExposure(Side side);
  void Begin(const CameraFault& fault);
  void End(const CameraFault& fault);
  FakeCamera& camera(const CameraFault& fault) {
    return *cameras_[fault.camera == "left" ? kLeft : kRight];
  }

  const StereoRig rig_;
  const double frame_rate_hz_;
  const std::int64_t start_exposure_us_;
  std::int64_t period_us_, exposure_us_;
  std::vector<Fault> faults_;
  std::atomic<std::int64_t> lost_{0};

  std::mutex mutex_;  // of shown_, sent_us_, leaving_, the pointers cameras_
  std::condition_variable changed_;
  std::array<std::shared_ptr<const StereoPicture>, 6> shown_;  // newest first
  std::array<std::int64_t, 2> sent_us_{0, 0};                  // due_us of the last sent
  bool leaving_{false};
  std::vector<std::shared_ptr<StereoPicture>> pool_;
  std::array<std::unique_ptr<FakeCamera>, 2> cameras_;  // last: their threads use the rest
};

}  // namespace visavis
