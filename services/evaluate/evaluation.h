#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "services/evaluate/error_statistics.h"
#include "services/evaluate/head_offset.h"
#include "services/evaluate/run_record.h"

namespace visavis {

// The rules of an evaluation.
inline constexpr double kSettle_s = 2;       ///< left out at the start of each session
inline constexpr int kFramesAfterJump = 10;  ///< left out, the first with the new truth included
inline constexpr double kWithin_m = 0.015;   ///< a good pose is within both
inline constexpr double kWithin_rad = 5 * M_PI / 180;
inline constexpr double kFalse_m = 0.030;  ///< a false TRACKING is beyond one of them
inline constexpr double kFalse_rad = 10 * M_PI / 180;

/// How close a run came to the truth, with or without a head offset.
struct Accuracy {
  ErrorStatistics errors;  ///< of TRACKING frames after the settling, but for those after a jump
  std::int64_t num_frames{0};  ///< that these are
  // Shares of all frames with truth; nothing where there are none.
  std::optional<double> share_within;          ///< TRACKING, within kWithin
  std::optional<double> share_false_tracking;  ///< TRACKING, beyond kFalse (or without a pose)
};

struct Evaluation {
  std::int64_t num_frames{0};
  std::int64_t num_frames_with_truth{0};
  std::optional<double> share_tracking;  ///< of the frames with truth
  /// [s] from the first frame to the first that is TRACKING within kWithin.
  std::optional<double> first_lock_s;
  /// For each jump, frames from the first with the new truth to the first TRACKING within kWithin
  /// (0: that very frame). A jump that is not recovered before the next one, or the end, counts
  /// with all the frames until then.
  std::vector<double> recovery_frames;
  std::int64_t num_not_recovered{0};
  Accuracy raw;
  std::optional<Accuracy> aligned;  ///< the head offset removed
  std::optional<HeadOffset> offset;
  std::vector<double> latencies_ms;

  std::array<std::int64_t, 3> num_by_status{0, 0, 0};  ///< of all frames, by TrackStatus
  std::int64_t num_no_head{0};                         ///< frames with no head there
  std::int64_t num_tracking_no_head{0};                ///< of these, TRACKING
};

/// Judges a run. Where an @p offset is known, first_lock_s and recovery_frames are judged on the
/// aligned error, else on the raw one.
Evaluation Evaluate(const RunRecord& record, const std::optional<HeadOffset>& offset);

/// Fits the head offset on the TRACKING frames with truth of a run, without the first
/// kFramesAfterJump frames of each session and after each jump (or with them, if fewer than
/// kMinPairs are left). The settling time is not left out: short reference views count too.
/// @throws std::invalid_argument where there are too few.
HeadOffset FitHeadOffset(const RunRecord& record);

/// Error of one frame, after the offset's removal if there is one; nothing where estimate or truth
/// is missing.
std::optional<RecognitionError> FrameError(const RunFrame& frame,
                                           const std::optional<HeadOffset>& offset);

}  // namespace visavis
