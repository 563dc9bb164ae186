#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/kinematics/arm.h"
#include "common/kinematics/sample_times.h"

namespace visavis {

/// Joints of an arm at one time.
struct JointSample {
  JointVector q;     ///< [rad or m]
  JointVector qdot;  ///< [rad/s or m/s]
  bool extrapolated;
  std::int64_t age_us;  ///< time asked for minus that of the newest sample not after it
};

/// The latest joint states of an arm, to be read at the times of exposures.
///
/// Between two samples q is the cubic through both positions with both velocities (Hermite), and
/// qdot its derivative; beyond the newest, q goes on at its last velocity. Straight lines would be
/// simpler but err by h^2/8 |q''|: for the demo arm on a shuttle of T = 1 s the camera is wrong by
/// 0.07 mm at 100 Hz, 1.8 mm at 20 Hz and 7 mm at 10 Hz; the cubic by less than 0.01 mm down to
/// 20 Hz and 0.08 mm at 10 Hz. Velocity noise of 0.01 rad/s adds 0.04 mm at 100 Hz
/// (camera_motion_test prints these). A driver without velocities must difference its positions.
///
/// Add() and At() allocate nothing.
class JointHistory {
 public:
  /// @param names  joints of the arm, in its order
  explicit JointHistory(std::vector<std::string> names, const HistoryOptions& options = {});

  /// Offers a joint state at @p utime_us. The joints may come in any order and among others (a
  /// gripper's); all of the arm's must be there once. Every sample is counted.
  SampleVerdict Add(std::int64_t utime_us, const std::vector<std::string>& names,
                    const Eigen::Ref<const Eigen::VectorXd>& q,
                    const Eigen::Ref<const Eigen::VectorXd>& qdot);

  /// None before the oldest sample, in a gap wider than max_gap_us, or later than one period after
  /// the newest.
  std::optional<JointSample> At(std::int64_t utime_us) const;

  void Clear() { times_.Clear(); }

  std::optional<std::int64_t> newest_us() const { return times_.newest_us(); }
  const SampleCounts& counts() const { return counts_; }

  /// Why the latest rejected sample was rejected: field, value, rule. Empty if none was.
  std::string DescribeLastRejection() const;

 private:
  SampleVerdict Judge(std::int64_t utime_us, const std::vector<std::string>& names,
                      const Eigen::Ref<const Eigen::VectorXd>& q,
                      const Eigen::Ref<const Eigen::VectorXd>& qdot);
  bool FindColumns(const std::vector<std::string>& names);

  std::vector<std::string> names_;
  std::vector<int> columns_;  ///< where each joint stood in the last message
  SampleTimes times_;
  Eigen::MatrixXd q_, qdot_;  ///< joints x capacity, a column a slot
  SampleCounts counts_;
  struct Rejection {
    SampleVerdict verdict{SampleVerdict::kAccepted};
    std::int64_t utime_us{0}, newest_us{0};
    int joint{0};  ///< index of the joint at fault
  } last_rejection_;
};

}  // namespace visavis
