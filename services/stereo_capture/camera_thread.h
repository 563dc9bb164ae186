#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "services/stereo_capture/camera_config.h"
#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_source.h"
#include "services/stereo_capture/picture_size.h"

namespace visavis {

/// A camera with a thread of its own, which opens it, reads it until it is lost, and begins anew.
/// The other camera never waits for this one.
class CameraThread : public FrameSource {
 public:
  CameraReport Report() const override;

 protected:
  using State = CameraReport::State;

  /// @param rig_size what pictures must measure; nothing: any @param queue aliased
  CameraThread(Side side, SideConfig device, CameraConfig config,
               std::optional<PictureSize> rig_size, FrameQueue* queue);
  /// To be called last by the heir's constructor, and first by its destructor: the thread is the
  /// heir's.
  void Begin();
  void End();

  /// One life of a connection, from the search to its loss. @return how long to wait [s] before the
  /// next. @throws CameraRefusal, for which the wait is a second, and others, 0.1 s.
  virtual double RunOnce() = 0;

  bool stopping() const { return stop_; }
  /// Ends sooner if the thread is to stop.
  void Wait(double seconds);
  /// Tells that the camera does not stream, and why.
  void Fail(State state, const std::string& text);
  std::string DeviceKeyValue() const;

  const Side side_;
  const SideConfig device_;
  const CameraConfig config_;
  const std::optional<PictureSize> rig_size_;
  FrameQueue& queue_;
  std::int64_t session_{0};  ///< the thread's own

  mutable std::mutex mutex_;
  CameraReport report_;  ///< under mutex_

 private:
  void Run();

  std::condition_variable stopping_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace visavis
