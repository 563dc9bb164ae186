#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace visavis {

/// What an export wrote.
struct ExportSummary {
  std::int64_t num_frames{0}, num_truth{0}, num_camera_poses{0}, num_arm_states{0};
  std::int64_t num_head_poses{0}, num_pictures{0};
  std::vector<std::string> notes;  ///< what was left out, and why: one line each
};

/// The reverse of ImportSequence: writes what the log holds of a recorded sequence into @p folder,
/// which must not exist or be empty, and head_pose.csv besides. The folder appears when it is
/// whole; until then it is @p folder + ".part", which a failure removes.
///
/// Frames are the stereo pairs with both images; in a log without images, the HEAD_POSE messages.
/// Truth and camera pose of a frame are those of its time, or interpolated where a clock of their
/// own stamped them. Numbers are written so that reading gives the same double.
/// @throws std::invalid_argument where @p log is no log or holds nothing to export, or @p folder is
/// in the way; std::runtime_error where something cannot be read or written.
ExportSummary ExportSequence(const std::string& log, const std::string& folder,
                             const std::string& prefix);

}  // namespace visavis
