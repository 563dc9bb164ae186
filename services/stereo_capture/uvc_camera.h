#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "services/stereo_capture/camera_config.h"
#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_source.h"
#include "services/stereo_capture/picture_size.h"

namespace visavis {

/// One UVC camera through V4L2, by its device file (best one of /dev/v4l/by-id, which survives a
/// replug). A thread of its own opens it, reads, and opens it again when it is lost.
class UvcCamera final : public FrameSource {
 public:
  /// @param rig_size what pictures must measure; nothing: any @param queue aliased
  UvcCamera(Side side, SideConfig device, CameraConfig config, std::optional<PictureSize> rig_size,
            FrameQueue* queue);
  ~UvcCamera() override;

  CameraReport Report() const override;

 private:
  void Run();
  /// Opens it, sets it up and reads until it is lost. @return how long to wait [s] then.
  double RunOnce();
  void Fail(CameraReport::State state, const std::string& text);
  bool stopping() const;

  const Side side_;
  const SideConfig device_;
  const CameraConfig config_;
  const std::optional<PictureSize> rig_size_;
  FrameQueue& queue_;
  std::int64_t session_{0};

  mutable std::mutex mutex_;  // of the two below
  CameraReport report_;
  bool stop_{false};
  std::condition_variable stopping_;
  std::thread thread_;
};

}  // namespace visavis
