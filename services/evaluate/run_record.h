#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

enum class TrackStatus { kSearching, kTracking, kLost };

/// One answer of the recogniser, and the truth at its time.
struct RunFrame {
  std::int64_t utime_us{0};
  double time_s{0};  ///< since the first frame of its session
  int session{0};    ///< counts jumps of time back by more than 1 s
  TrackStatus status{TrackStatus::kSearching};
  std::optional<RigidTransform> X_CM;        ///< the estimate
  std::optional<RigidTransform> X_CM_truth;  ///< nothing: unknown, or no head there
  bool no_head{false};                       ///< known that no head is there
  bool jump{false};  ///< the first frame at or after a jump of the truth (see TruthTrack)
};

/// What one run of the recogniser answered.
struct RunRecord {
  std::vector<RunFrame> frames;  ///< one a HEAD_POSE, in the log's order
  std::vector<double> latencies_ms;
  std::int64_t num_rejected{0};  ///< messages left out because they make no sense
  std::string last_reject;
  std::int64_t num_damaged_bytes{0};  ///< of the log
};

/// Reads HEAD_POSE, HEAD_POSE_TRUTH and RECOGNISER_TIMING of a log. The camera's pose, which jumps
/// of the truth are judged against, is that of the truth's pose in the world, else CAMERA_POSE's,
/// else the one that HEAD_POSE was given (its poses in camera and world make it).
/// @throws std::invalid_argument where there is no HEAD_POSE, std::runtime_error where the file
/// cannot be read.
RunRecord ReadRunRecord(const std::string& log, const std::string& prefix);

}  // namespace visavis
