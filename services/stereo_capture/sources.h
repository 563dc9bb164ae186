#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_source.h"
#include "services/stereo_capture/picture_size.h"
#include "services/stereo_capture/stereo_capture_config.h"

namespace visavis {

/// The sources of both sides, by Index(Side); one that serves both stands in both places.
using StereoSources = std::array<std::shared_ptr<FrameSource>, 2>;

/// What config.source says, begun. @param rig_sizes by Index(Side) @param queue aliased
/// @throws std::invalid_argument for pictures that cannot be read.
StereoSources MakeSources(const StereoCaptureConfig& config,
                          const std::array<std::optional<PictureSize>, 2>& rig_sizes,
                          FrameQueue* queue);

/// Cameras found, and what each supports, for people.
std::string ListCameras();

}  // namespace visavis
