#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "common/geometry/truth_track.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/recogniser_timing_t.hpp"

namespace visavis {

/// What came in the last second, as one line of at most 80 columns for a terminal.
class PoseSummary {
 public:
  void AddPose(const head_pose_t& pose);
  void AddTruth(const head_pose_t& truth);
  void AddTiming(const recogniser_timing_t& timing);

  /// Names of the columns of Line().
  static std::string Header();

  /// The line for the time since the last call: newest pose, RMS error of the poses whose truth
  /// came, fitness, poses a second, median latency. @p elapsed_s since the last call.
  std::string Line(double elapsed_s);

  std::int64_t num_poses() const { return num_poses_; }

 private:
  /// Takes the poses whose truth is known by now (see TruthTrack) into the errors.
  void AddErrors();

  head_pose_t newest_{};
  std::deque<head_pose_t> poses_;   // whose truth may still come; bounded
  std::deque<TruthSample> truths_;  // bounded
  std::deque<double> latencies_ms_;
  std::int64_t num_poses_{0}, poses_since_{0};
  double sum_squared_mm_{0}, sum_squared_deg_{0};
  int num_errors_{0};
};

}  // namespace visavis
