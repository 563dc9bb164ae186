#pragma once

#include <cstdint>
#include <future>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "services/stereo_capture/aravis_connection.h"
#include "services/stereo_capture/camera_thread.h"

namespace visavis {

/// One GigE Vision or USB3 Vision camera. Its thread finds it by name, takes control, sets it up,
/// and pops its frames; when nothing comes for stall_ms it lets go (in a further thread, since that
/// may take seconds) and begins anew.
class AravisCamera final : public CameraThread {
 public:
  AravisCamera(Side side, SideConfig device, CameraConfig config,
               std::optional<PictureSize> rig_size, FrameQueue* queue);
  ~AravisCamera() override;

 private:
  double RunOnce() override;
  std::optional<FoundCamera> Find();
  bool TakeControl(AravisConnection* connection, const std::string& camera);
  /// The configuration, with the size of packets for this camera where it leaves that to us: what
  /// camera and interface take, or what every link does once the first had no success.
  CameraConfig ConfigFor(const FoundCamera& found, ArvCamera* camera) const;
  /// @return whether any good frame came.
  bool Stream(AravisConnection* connection, CameraFormat format);
  /// Passes one buffer on, or counts what is wrong with it. @return whether it was good.
  bool Take(const AravisConnection& connection, const std::shared_ptr<ArvBuffer>& buffer,
            const CameraFormat& format);
  /// What is wrong with a buffer; empty: nothing.
  std::string Fault(const AravisConnection& connection, ArvBuffer* buffer,
                    const CameraFormat& format);
  /// Whether silence is what it should be: nobody pulls the trigger, and the camera answers.
  bool WaitsForTrigger(const AravisConnection& connection);
  void TearDown(std::unique_ptr<AravisConnection> connection);

  // The thread's own.
  std::string last_address_;
  bool small_packets_{false};
  // Of this session: the newest good frame's time, frames in succession that are not newer, packets
  // of wrong size so far.
  std::int64_t newest_ns_{0}, num_stale_{0}, num_wrong_sizes_{0};
  double distrust_until_s_{0};
  std::list<std::future<void>> teardowns_;
};

}  // namespace visavis
