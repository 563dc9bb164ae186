#include "services/stereo_capture/sources.h"

#include "services/stereo_capture/aravis_camera.h"
#include "services/stereo_capture/picture_source.h"
#include "services/stereo_capture/uvc_camera.h"

namespace visavis {
namespace {

template <typename Camera>
StereoSources TwoCameras(const StereoCaptureConfig& config,
                         const std::array<std::optional<PictureSize>, 2>& rig_sizes,
                         FrameQueue* queue) {
  return {std::make_shared<Camera>(Side::kLeft, config.left, config.camera,
                                   rig_sizes[Index(Side::kLeft)], queue),
          std::make_shared<Camera>(Side::kRight, config.right, config.camera,
                                   rig_sizes[Index(Side::kRight)], queue)};
}

}  // namespace

StereoSources MakeSources(const StereoCaptureConfig& config,
                          const std::array<std::optional<PictureSize>, 2>& rig_sizes,
                          FrameQueue* queue) {
  if (config.source == "aravis") return TwoCameras<AravisCamera>(config, rig_sizes, queue);
  if (config.source == "uvc") return TwoCameras<UvcCamera>(config, rig_sizes, queue);
  auto reader = config.source == "folder" ? OpenFolder(config.folder)
                                          : OpenVideos(config.left.device, config.right.device);
  const auto both = std::make_shared<PictureSource>(config, std::move(reader), rig_sizes, queue);
  return {both, both};
}

}  // namespace visavis
