#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/gige/gobject.h"
#include "common/gige/gvcp_discovery.h"
#include "services/stereo_capture/aravis_settings.h"

namespace visavis {

/// A camera that answers, by GigE Vision or USB3 Vision.
struct FoundCamera {
  GvcpDevice device;   ///< addresses are empty for USB
  std::string usb_id;  ///< Aravis's name of a USB camera; empty: GigE
  std::string text() const;
};

/// Cameras that answer to @p name (see IsCalled()), or all if it is empty. USB is asked where GigE
/// has none of that name. @param wait_ms for GigE cameras' answers
/// @param last_address asked directly too; may be empty
std::vector<FoundCamera> FindCameras(const std::string& name, int wait_ms,
                                     const std::string& last_address);

/// Control of one camera, and its stream once it runs. The destructor may take seconds where the
/// camera is gone: it belongs into a thread of its own.
class AravisConnection {
 public:
  /// Opens without taking control for granted. @throws CameraLost.
  explicit AravisConnection(const FoundCamera& found);
  ~AravisConnection();
  AravisConnection(const AravisConnection&) = delete;
  AravisConnection& operator=(const AravisConnection&) = delete;

  ArvCamera* camera() const { return camera_.get(); }
  /// Whether the camera obeys us; asks for it anew where it does not.
  bool TakeControl();
  /// Set by Aravis once the camera has not answered for seconds.
  bool control_lost() const { return control_lost_; }
  /// Whether the destructor tells the camera to stop, true at first. One that is gone takes seconds
  /// not to hear it.
  void set_farewell(bool farewell) { farewell_ = farewell; }

  /// Makes the stream and starts it. @throws CameraLost.
  void Start(const CameraConfig& config, std::size_t payload_bytes);
  /// The next buffer, whatever its status; nullptr after @p timeout_us. It goes back to the stream,
  /// or is freed if that is gone, when the last copy of the pointer goes.
  std::shared_ptr<ArvBuffer> Pop(std::uint64_t timeout_us);
  /// The memory of a buffer that came from Pop(), which lives as long as the buffer.
  static std::shared_ptr<std::vector<std::uint8_t>> Pixels(
      const std::shared_ptr<ArvBuffer>& buffer);
  /// Count of the stream's, e.g. n_missing_packets.
  std::int64_t Count(const char* name) const;

 private:
  /// Where buffers go back to, as long as it is there.
  struct Return {
    std::mutex mutex;
    ArvStream* stream{nullptr};
  };

  const std::string address_;  // of a GigE camera
  ObjectPtr<ArvCamera> camera_;
  ObjectPtr<ArvStream> stream_;
  std::shared_ptr<Return> return_{std::make_shared<Return>()};
  std::atomic<bool> control_lost_{false};
  bool farewell_{true};
};

}  // namespace visavis
