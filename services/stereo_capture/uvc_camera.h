#pragma once

#include <optional>

#include "services/stereo_capture/camera_thread.h"

namespace visavis {

/// One UVC camera through V4L2, by its device file (best one of /dev/v4l/by-id, which survives a
/// replug).
class UvcCamera final : public CameraThread {
 public:
  UvcCamera(Side side, SideConfig device, CameraConfig config, std::optional<PictureSize> rig_size,
            FrameQueue* queue);
  ~UvcCamera() override;

 private:
  double RunOnce() override;
};

}  // namespace visavis
