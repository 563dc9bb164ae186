#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/rigs/rig_description.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_timing.h"
#include "services/stereo_capture/sources.h"
#include "services/stereo_capture/stereo_capture_config.h"
#include "services/stereo_capture/stereo_capture_messages.h"
#include "services/stereo_capture/stereo_pairer.h"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// Publishes STEREO_IMAGES from two cameras, and STEREO_RIG once a second: pairs whose
/// mid-exposures in host time are within the tolerance; single images while one camera is away.
///
/// The cameras' threads push into one bounded queue; all else happens in the service's thread.
class StereoCaptureService final : public Service {
 public:
  static ServiceTraits Traits();
  /// What --list prints.
  static std::string List() { return ListCameras(); }

  /// Waits a moment for the cameras' first words. @throws std::invalid_argument where a camera that
  /// is there cannot do what the configuration asks, or, with start: require, is not there.
  StereoCaptureService(const StereoCaptureConfig& config, const ServiceContext& context);
  ~StereoCaptureService() override;

  int wake_fd() const override { return queue_.fd(); }
  std::int64_t next_wake_us() const override;
  void Wake() override;
  bool finished() const override;
  void UpdateStatus() override;

 private:
  /// Skews of the pairs since the last status.
  struct Skews {
    std::int64_t count{0}, sum_us{0}, worst_us{0};
  };

  void AwaitCameras();
  void Take(CapturedFrame frame);
  /// Whether a camera has sent nothing usable for longer than a stall.
  bool IsAway(Side side, std::int64_t now_us) const;
  void Publish(const images_t& images);
  void TellStatusOf(Side side);
  void TellStatusOfPairs();

  const StereoCaptureConfig config_;
  const ServiceContext context_;
  std::optional<RigDescription> rig_;
  stereo_rig_t rig_message_;
  ImagesMessage message_;
  StereoPairer<StampedFrame> pairer_;
  std::array<FrameTiming, 2> timing_;
  std::array<std::int64_t, 2> last_usable_us_;
  std::int64_t next_rig_us_, seq_{0}, num_pairs_{0}, num_singles_{0}, told_unpaired_{0};
  Skews skews_;
  std::array<std::string, 2> told_errors_;  // the cameras' newest, as last put into the status
  FrameQueue queue_;
  StereoSources sources_;  // last: their threads end first
};

}  // namespace visavis
