#include "services/watch/pose_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "common/convert/pose_message.h"
#include "common/geometry/head_angles.h"

namespace visavis {
namespace {

constexpr std::size_t kMaxKept = 400;  // 2 s of the fastest cameras
constexpr double kDegree = M_PI / 180;

const char* StatusWord(int status) {
  switch (status) {
    case head_pose_t::STATUS_SEARCHING:
      return "searching";
    case head_pose_t::STATUS_TRACKING:
      return "TRACKING";
    default:
      return "lost";
  }
}

// A number in @p width columns, or dashes where there is none.
std::string Column(double value, int width, int decimals) {
  char text[32];
  if (std::isfinite(value)) {
    std::snprintf(text, sizeof text, "%*.*f", width, decimals, value);
  } else {
    std::snprintf(text, sizeof text, "%*s", width, "-");
  }
  return text;
}

}  // namespace

void PoseSummary::AddPose(const head_pose_t& pose) {
  newest_ = pose;
  ++num_poses_;
  ++poses_since_;
  poses_.push_back(pose);
  if (poses_.size() > kMaxKept) poses_.pop_front();
}

void PoseSummary::AddTruth(const head_pose_t& truth) {
  truths_.push_back({truth.utime, std::nullopt, {}});
  if (HasPose(truth)) truths_.back().X_CM = FromMessage(truth);
  if (truths_.size() > kMaxKept) truths_.pop_front();
}

void PoseSummary::AddErrors() {
  std::vector<std::int64_t> utimes_us;
  for (const head_pose_t& pose : poses_) utimes_us.push_back(pose.utime);
  const TruthTrack track({truths_.begin(), truths_.end()}, utimes_us);
  const std::int64_t known_until_us = track.samples().empty() ? 0 : track.samples().back().utime_us;
  std::deque<head_pose_t> waiting;
  for (const head_pose_t& pose : poses_) {
    const auto truth = track.At(pose.utime);
    if (truth && truth->X_CM && HasPose(pose)) {
      const auto error = ComputeRecognitionError(*truth->X_CM, FromMessage(pose));
      sum_squared_mm_ += 1e6 * error.position.squaredNorm();
      sum_squared_deg_ += std::pow(error.total_angle / kDegree, 2);
      ++num_errors_;
    } else if (!truth && pose.utime > known_until_us) {
      waiting.push_back(pose);
    }
  }
  poses_ = std::move(waiting);
}

void PoseSummary::AddTiming(const recogniser_timing_t& timing) {
  latencies_ms_.push_back(timing.latency_ms);
}

std::string PoseSummary::Header() {
  return "status        x    y    z mm   Phi theta   psi deg  err mm   deg    F   Hz   ms";
}

std::string PoseSummary::Line(double elapsed_s) {
  AddErrors();
  const bool any = poses_since_ > 0;
  const double nan = std::nan("");
  const auto pose = [&](double value) { return any ? value : nan; };
  double latency_ms = nan;
  if (!latencies_ms_.empty()) {
    const auto middle =
        latencies_ms_.begin() + static_cast<std::ptrdiff_t>(latencies_ms_.size() / 2);
    std::nth_element(latencies_ms_.begin(), middle, latencies_ms_.end());
    latency_ms = *middle;
  }
  char status[16];
  std::snprintf(status, sizeof status, "%-9s", any ? StatusWord(newest_.status) : "no pose");
  std::string line = status;
  for (const double p : newest_.p_CM_m) line += Column(pose(1e3 * p), 5, 0);
  line += "   ";
  for (const double a : newest_.euler_zyx_CM_rad) line += Column(pose(a / kDegree), 6, 1);
  line += "    ";
  line += Column(num_errors_ ? std::sqrt(sum_squared_mm_ / num_errors_) : nan, 8, 1);
  line += Column(num_errors_ ? std::sqrt(sum_squared_deg_ / num_errors_) : nan, 6, 1);
  line += Column(pose(newest_.fitness), 5, 2);
  line += Column(elapsed_s > 0 ? static_cast<double>(poses_since_) / elapsed_s : nan, 5, 0);
  line += Column(latency_ms, 5, latency_ms < 10 ? 1 : 0);
  poses_since_ = 0;
  num_errors_ = 0;
  sum_squared_mm_ = sum_squared_deg_ = 0;
  latencies_ms_.clear();
  return line;
}

}  // namespace visavis
