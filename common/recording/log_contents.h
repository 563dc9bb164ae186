#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/pose_track.h"
#include "common/geometry/truth_track.h"
#include "common/rigs/rig_description.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/recogniser_timing_t.hpp"

namespace visavis {

/// What a log holds of a recording, but for the pictures. Each in the order of its events.
struct LogContents {
  std::optional<RigDescription> rig;  ///< the first one
  std::vector<StampedPose> camera_poses;
  std::vector<arm_state_t> arm_states;
  std::vector<TruthSample> truth;
  std::vector<head_pose_t> head_poses;
  std::vector<recogniser_timing_t> timings;
  std::int64_t num_rejected{0};  ///< messages that do not decode or make no sense
  std::string last_reject;       ///< "CHANNEL: why" of the last of them
  std::int64_t num_events{0};
  std::int64_t num_damaged_bytes{0};
};

/// Reads a whole log; each stereo message goes to @p on_images in passing (empty: images are not
/// decoded). One that @p on_images refuses with std::invalid_argument is counted as rejected.
/// @p prefix goes before every channel.
/// @throws std::runtime_error where the file cannot be read, std::invalid_argument where it is no
/// event log.
LogContents ReadLog(const std::string& path, const std::string& prefix,
                    const std::function<void(const images_t&)>& on_images);

}  // namespace visavis
