#pragma once

#include <cstdint>
#include <string>

#include "services/log_tool/recorded_sequence.h"

namespace visavis {

/// What an import wrote.
struct ImportSummary {
  std::int64_t num_frames{0}, num_truth{0}, num_camera_poses{0}, num_arm_states{0};
  std::int64_t num_bytes{0};
  double duration_s{0};  ///< first to last frame
};

/// Writes a recorded sequence as a standard event log, each event at the time it speaks of.
/// STEREO_RIG comes first and once a second; at equal times CAMERA_POSE, ARM_STATE and
/// HEAD_POSE_TRUTH precede STEREO_IMAGES. An image's metadata `seq` is the frame's number.
///
/// The log appears under its name only when it is whole (ProvisionalFile). @p prefix goes before
/// every channel.
/// @throws std::invalid_argument for a bad folder (see ReadRecordedSequence) or picture,
/// std::runtime_error where the log cannot be written.
ImportSummary ImportSequence(const std::string& folder, const std::string& log,
                             const std::string& prefix);

}  // namespace visavis
