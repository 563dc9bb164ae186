#include "services/evaluate/run_record.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"
#include "common/geometry/pose_track.h"
#include "common/geometry/truth_track.h"
#include "common/recording/log_contents.h"

namespace visavis {
namespace {

constexpr std::int64_t kNewSessionUs = 1'000'000;
constexpr std::int64_t kMaxCameraGapUs = 100'000;

std::optional<RigidTransform> Estimate(const head_pose_t& message) {
  try {
    return FromMessage(message);
  } catch (const MessageError&) {
    return std::nullopt;
  }
}

/// Camera poses as far as the log tells them.
PoseTrack CameraTrack(const LogContents& contents) {
  if (!contents.camera_poses.empty()) return PoseTrack(contents.camera_poses);
  std::vector<StampedPose> poses;
  for (const auto& message : contents.head_poses) {
    const auto X_CM = Estimate(message);
    if (!X_CM || !message.has_world_pose) continue;
    try {
      const RigidTransform X_WM = ReadTransform("X_WM", message.p_WM_m, message.q_WM_wxyz);
      poses.push_back({message.utime, X_WM * X_CM->inverse()});
    } catch (const MessageError&) {
    }
  }
  return PoseTrack(poses);
}

TruthTrack MakeTruthTrack(LogContents* contents) {
  const PoseTrack camera = CameraTrack(*contents);
  for (TruthSample& sample : contents->truth) {
    const auto X_WC = camera.At(sample.utime_us, kMaxCameraGapUs);
    if (sample.X_CM && !sample.X_WM && X_WC) sample.X_WM = *X_WC * *sample.X_CM;
  }
  std::vector<std::int64_t> utimes_us;
  for (const auto& message : contents->head_poses) utimes_us.push_back(message.utime);
  return TruthTrack(contents->truth, utimes_us);
}

void MarkJumps(const std::vector<std::int64_t>& jump_utimes_us, std::vector<RunFrame>* frames) {
  for (std::size_t i = 1; i < frames->size(); ++i) {
    const RunFrame& last = (*frames)[i - 1];
    RunFrame& frame = (*frames)[i];
    if (frame.session != last.session) continue;
    const auto jump = std::upper_bound(jump_utimes_us.begin(), jump_utimes_us.end(), last.utime_us);
    frame.jump = jump != jump_utimes_us.end() && *jump <= frame.utime_us;
  }
}

}  // namespace

RunRecord ReadRunRecord(const std::string& log, const std::string& prefix) {
  LogContents contents = ReadLog(log, prefix, nullptr);
  if (contents.head_poses.empty()) {
    throw std::invalid_argument(log + ": must hold " + prefix + kHeadPoseChannel);
  }
  const TruthTrack truth = MakeTruthTrack(&contents);

  RunRecord record;
  std::int64_t session_start_us = contents.head_poses[0].utime;
  for (const auto& message : contents.head_poses) {
    RunFrame frame;
    if (!record.frames.empty()) {
      const RunFrame& last = record.frames.back();
      const bool new_session = message.utime < last.utime_us - kNewSessionUs;
      frame.session = last.session + (new_session ? 1 : 0);
      if (new_session) session_start_us = message.utime;
    }
    frame.utime_us = message.utime;
    frame.time_s = 1e-6 * static_cast<double>(message.utime - session_start_us);
    frame.status = message.status == head_pose_t::STATUS_TRACKING ? TrackStatus::kTracking
                   : message.status == head_pose_t::STATUS_LOST   ? TrackStatus::kLost
                                                                  : TrackStatus::kSearching;
    frame.X_CM = Estimate(message);
    if (const auto sample = truth.At(message.utime)) {
      frame.X_CM_truth = sample->X_CM;
      frame.no_head = !sample->X_CM;
    }
    record.frames.push_back(std::move(frame));
  }
  MarkJumps(truth.jump_utimes_us(), &record.frames);
  for (const auto& timing : contents.timings) {
    if (std::isfinite(timing.latency_ms)) record.latencies_ms.push_back(timing.latency_ms);
  }
  record.num_rejected = contents.num_rejected;
  record.last_reject = contents.last_reject;
  record.num_damaged_bytes = contents.num_damaged_bytes;
  return record;
}

}  // namespace visavis
