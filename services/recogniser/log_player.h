#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/eventlog/event_log.h"
#include "services/recogniser/ego_motion.h"
#include "services/recogniser/frame_preparer.h"
#include "services/recogniser/recogniser_config.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// Reads a log pair by pair, decoded once, so that many estimators can be run on each pair: what
/// the recogniser's service does for one. A pair is handed out once a motion sample at or after it
/// has come, or the next pair, or the log has ended.
class LogPlayer {
 public:
  /// Of @p config count channels, ego_motion, and rig_file where the log holds no rig.
  /// @throws std::runtime_error where neither gives a rig.
  explicit LogPlayer(const std::string& path, const RecogniserConfig& config = {});

  const StereoRig& rig() const { return rig_; }

  struct Pair {
    StereoFrame frame;
    CameraStep step;                      ///< from the pair before
    std::optional<RigidTransform> truth;  ///< X_CM
  };
  /// The next pair, valid until the next call; null at the end.
  const Pair* Next();

 private:
  void ReadRig(const std::string& rig_file);
  void SetRig(const RigDescription& rig);
  bool ReadUntilReady();

  const RecogniserChannels channels_;
  EventLogReader reader_;
  LogEvent event_;
  StereoRig rig_;
  EgoMotion motion_;
  std::unique_ptr<FramePreparer> preparer_;
  images_t images_;
  bool has_images_{false};
  std::optional<images_t> later_images_;  ///< came while images_ still waited for its motion
  std::optional<std::int64_t> last_utime_us_;
  std::map<std::int64_t, RigidTransform> truths_;
  Pair pair_;
};

}  // namespace visavis
