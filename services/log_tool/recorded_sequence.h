#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/pose_track.h"
#include "common/rigs/rig_description.h"

namespace visavis {

/// A stereo pair of a recorded sequence.
struct SequenceFrame {
  std::int64_t number{0};    ///< as in frames.csv
  std::int64_t utime_us{0};  ///< round(time_s * 1e6)
  std::string left, right;   ///< picture files, with the folder's path
  std::string place;         ///< "frames.csv:LINE", with the folder's path
};

/// The true pose of the head in one frame.
struct SequenceTruth {
  std::size_t frame{0};  ///< index into RecordedSequence::frames
  RigidTransform X_CM{RigidTransform::Identity()};
};

/// Joint positions of the arm at one time.
struct SequenceArmState {
  std::int64_t utime_us{0};
  std::vector<double> positions;   ///< [rad or m] in the order of joint_names
  std::vector<double> velocities;  ///< [rad/s or m/s] differences of the neighbours' positions
};

/// A recorded sequence as a folder: rig.yaml, frames.csv, and where they exist camera_pose.csv,
/// arm.csv and truth.csv. The pictures themselves stay on disk.
struct RecordedSequence {
  RigDescription rig;
  std::vector<SequenceFrame> frames;         ///< by time, at least one
  std::vector<StampedPose> camera_poses;     ///< X_WC, by time, at times of frames
  std::vector<std::string> joint_names;      ///< empty: no arm.csv
  std::vector<SequenceArmState> arm_states;  ///< by time
  std::vector<SequenceTruth> truth;          ///< by time; frames without a row are unknown
};

/// Reads and checks a folder; further columns and files are ignored.
/// @throws std::invalid_argument: one line with file, line, column, value and rule.
RecordedSequence ReadRecordedSequence(const std::string& folder);

}  // namespace visavis
