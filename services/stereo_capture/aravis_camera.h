#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <future>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "services/stereo_capture/aravis_connection.h"
#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_source.h"

namespace visavis {

/// One GigE Vision or USB3 Vision camera. A thread of its own finds it by name, takes control, sets
/// it up, and pops its frames; when nothing comes for stall_ms it lets go (in a further thread,
/// since that may take seconds) and begins anew. The other camera never waits for this one.
class AravisCamera final : public FrameSource {
 public:
  /// @param rig_size what pictures must measure; nothing: any @param queue aliased
  AravisCamera(Side side, SideConfig device, CameraConfig config,
               std::optional<PictureSize> rig_size, FrameQueue* queue);
  ~AravisCamera() override;

  CameraReport Report() const override;

 private:
  using State = CameraReport::State;

  void Run();
  /// One life of a connection, from the search to its loss. @return how long to wait [s] before the
  /// next attempt.
  double RunOnce();
  std::optional<FoundCamera> Find();
  bool TakeControl(AravisConnection* connection, const std::string& camera);
  void Stream(AravisConnection* connection, CameraFormat format);
  /// Passes one buffer on, or counts what is wrong with it. @return whether it was good.
  bool Take(const AravisConnection& connection, const std::shared_ptr<ArvBuffer>& buffer,
            const CameraFormat& format);
  /// What is wrong with a buffer; empty: nothing.
  std::string Fault(const AravisConnection& connection, ArvBuffer* buffer,
                    const CameraFormat& format);
  /// Whether silence is what it should be: nobody pulls the trigger, and the camera answers.
  bool WaitsForTrigger(const AravisConnection& connection);
  void TearDown(std::unique_ptr<AravisConnection> connection);
  void Fail(State state, const std::string& text);
  void Wait(double seconds);

  const Side side_;
  const SideConfig device_;
  const CameraConfig config_;
  const std::optional<PictureSize> rig_size_;
  FrameQueue& queue_;

  // The thread's own.
  std::string last_address_;
  std::int64_t session_{0};
  // Of this session: the newest good frame's time, frames in succession that are not newer, packets
  // of wrong size so far.
  std::int64_t newest_ns_{0}, num_stale_{0}, num_wrong_sizes_{0};
  double distrust_until_s_{0};
  std::list<std::future<void>> teardowns_;

  mutable std::mutex mutex_;  // of the two below
  CameraReport report_;
  std::condition_variable stopping_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace visavis
