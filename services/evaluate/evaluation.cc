#include "services/evaluate/evaluation.h"

namespace visavis {
namespace {

bool IsWithin(const RecognitionError& e) {
  return e.position.norm() <= kWithin_m && e.total_angle <= kWithin_rad;
}

bool IsFalse(const RecognitionError& e) {
  return e.position.norm() > kFalse_m || e.total_angle > kFalse_rad;
}

/// For each frame, the number of frames since the last jump of its session; large without one.
std::vector<int> FramesSinceJump(const std::vector<RunFrame>& frames) {
  constexpr int kNever = 1 << 30;
  std::vector<int> since(frames.size(), kNever);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].jump) {
      since[i] = 0;
    } else if (i > 0 && frames[i].session == frames[i - 1].session && since[i - 1] < kNever) {
      since[i] = since[i - 1] + 1;
    }
  }
  return since;
}

bool IsGood(const RunFrame& frame, const std::optional<HeadOffset>& offset) {
  if (frame.status != TrackStatus::kTracking) return false;
  const auto error = FrameError(frame, offset);
  return error && IsWithin(*error);
}

Accuracy ComputeAccuracy(const std::vector<RunFrame>& frames, const std::vector<int>& since_jump,
                         const std::optional<HeadOffset>& offset) {
  std::vector<RecognitionError> errors;
  std::int64_t with_truth = 0, within = 0, wrong = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const RunFrame& frame = frames[i];
    if (!frame.X_CM_truth) continue;
    ++with_truth;
    if (frame.status != TrackStatus::kTracking) continue;
    const auto error = FrameError(frame, offset);
    if (error && IsWithin(*error)) ++within;
    if (!error || IsFalse(*error)) ++wrong;
    const bool counts = frame.time_s >= kSettle_s && since_jump[i] >= kFramesAfterJump;
    if (error && counts) errors.push_back(*error);
  }
  Accuracy accuracy;
  accuracy.errors = ComputeErrorStatistics(errors);
  accuracy.num_frames = static_cast<std::int64_t>(errors.size());
  if (with_truth > 0) {
    const auto share = [&](std::int64_t n) {
      return static_cast<double>(n) / static_cast<double>(with_truth);
    };
    accuracy.share_within = share(within);
    accuracy.share_false_tracking = share(wrong);
  }
  return accuracy;
}

void FindRecoveries(const std::vector<RunFrame>& frames, const std::optional<HeadOffset>& offset,
                    Evaluation* evaluation) {
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].jump) continue;
    std::size_t k = i;
    bool recovered = false;
    for (; k < frames.size() && frames[k].session == frames[i].session; ++k) {
      if (k > i && frames[k].jump) break;
      recovered = IsGood(frames[k], offset);
      if (recovered) break;
    }
    evaluation->recovery_frames.push_back(static_cast<double>(k - i));
    if (!recovered) ++evaluation->num_not_recovered;
  }
}

}  // namespace

std::optional<RecognitionError> FrameError(const RunFrame& frame,
                                           const std::optional<HeadOffset>& offset) {
  if (!frame.X_CM || !frame.X_CM_truth) return std::nullopt;
  return ComputeRecognitionError(*frame.X_CM_truth,
                                 offset ? RemoveOffset(*frame.X_CM, *offset) : *frame.X_CM);
}

Evaluation Evaluate(const RunRecord& record, const std::optional<HeadOffset>& offset) {
  const std::vector<RunFrame>& frames = record.frames;
  const std::vector<int> since_jump = FramesSinceJump(frames);
  Evaluation evaluation;
  evaluation.num_frames = static_cast<std::int64_t>(frames.size());
  std::int64_t tracking_with_truth = 0;
  for (const RunFrame& frame : frames) {
    const bool tracking = frame.status == TrackStatus::kTracking;
    ++evaluation.num_by_status[static_cast<std::size_t>(frame.status)];
    if (frame.X_CM_truth) ++evaluation.num_frames_with_truth;
    if (frame.X_CM_truth && tracking) ++tracking_with_truth;
    if (frame.no_head) ++evaluation.num_no_head;
    if (frame.no_head && tracking) ++evaluation.num_tracking_no_head;
    if (frame.session == 0 && !evaluation.first_lock_s && IsGood(frame, offset)) {
      evaluation.first_lock_s = frame.time_s;
    }
  }
  if (evaluation.num_frames_with_truth > 0) {
    evaluation.share_tracking = static_cast<double>(tracking_with_truth) /
                                static_cast<double>(evaluation.num_frames_with_truth);
  }
  FindRecoveries(frames, offset, &evaluation);
  evaluation.raw = ComputeAccuracy(frames, since_jump, std::nullopt);
  if (offset) evaluation.aligned = ComputeAccuracy(frames, since_jump, offset);
  evaluation.offset = offset;
  evaluation.latencies_ms = record.latencies_ms;
  return evaluation;
}

HeadOffset FitHeadOffset(const RunRecord& record) {
  const std::vector<int> since_jump = FramesSinceJump(record.frames);
  std::vector<TruthAndEstimate> settled, all;
  std::size_t session_start = 0;
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    const RunFrame& frame = record.frames[i];
    if (frame.session != record.frames[session_start].session) session_start = i;
    if (frame.status != TrackStatus::kTracking || !frame.X_CM || !frame.X_CM_truth) continue;
    all.push_back({*frame.X_CM_truth, *frame.X_CM});
    if (i - session_start >= kFramesAfterJump && since_jump[i] >= kFramesAfterJump) {
      settled.push_back(all.back());
    }
  }
  return FitHeadOffset(settled.size() >= static_cast<std::size_t>(kMinPairs) ? settled : all);
}

}  // namespace visavis
