#include "common/kinematics/joint_history.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/check.h"

namespace visavis {

JointHistory::JointHistory(std::vector<std::string> names, const HistoryOptions& options)
    : names_(std::move(names)), columns_(names_.size(), 0), times_(options) {
  VISAVIS_THROW_UNLESS(!names_.empty() && names_.size() <= kMaxArmJoints, names_.size());
  const auto n = static_cast<Eigen::Index>(names_.size());
  q_ = Eigen::MatrixXd::Zero(n, options.capacity);
  qdot_ = q_;
}

bool JointHistory::FindColumns(const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    int found = -1;
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (names[k] != names_[i]) continue;
      if (found >= 0) found = -2;
      if (found == -1) found = static_cast<int>(k);
    }
    if (found < 0) {
      last_rejection_.joint = static_cast<int>(i);
      return false;
    }
    columns_[i] = found;
  }
  return true;
}

SampleVerdict JointHistory::Judge(std::int64_t utime_us, const std::vector<std::string>& names,
                                  const Eigen::Ref<const Eigen::VectorXd>& q,
                                  const Eigen::Ref<const Eigen::VectorXd>& qdot) {
  last_rejection_.joint = 0;
  if (q.size() != qdot.size() || q.size() != static_cast<Eigen::Index>(names.size())) {
    return SampleVerdict::kWrongNames;
  }
  if (!FindColumns(names)) return SampleVerdict::kWrongNames;
  for (std::size_t i = 0; i < names_.size(); ++i) {
    if (!std::isfinite(q[columns_[i]]) || !std::isfinite(qdot[columns_[i]])) {
      last_rejection_.joint = static_cast<int>(i);
      return SampleVerdict::kNotFinite;
    }
  }
  return times_.Judge(utime_us);
}

SampleVerdict JointHistory::Add(std::int64_t utime_us, const std::vector<std::string>& names,
                                const Eigen::Ref<const Eigen::VectorXd>& q,
                                const Eigen::Ref<const Eigen::VectorXd>& qdot) {
  const SampleVerdict verdict = Judge(utime_us, names, q, qdot);
  counts_.Count(verdict);
  if (verdict != SampleVerdict::kAccepted) {
    last_rejection_.verdict = verdict;
    last_rejection_.utime_us = utime_us;
    last_rejection_.newest_us = times_.newest_us().value_or(0);
    return verdict;
  }
  if (times_.IsRestart(utime_us)) ++counts_.restarts;
  const int slot = times_.Push(utime_us);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    q_(static_cast<Eigen::Index>(i), slot) = q[columns_[i]];
    qdot_(static_cast<Eigen::Index>(i), slot) = qdot[columns_[i]];
  }
  return verdict;
}

std::optional<JointSample> JointHistory::At(std::int64_t utime_us) const {
  const auto bracket = times_.Find(utime_us);
  if (!bracket) return std::nullopt;
  const auto q_0 = q_.col(bracket->slot_0), q_1 = q_.col(bracket->slot_1);
  const auto v_0 = qdot_.col(bracket->slot_0), v_1 = qdot_.col(bracket->slot_1);
  JointSample sample{q_1, v_1, bracket->extrapolated, bracket->age_us};
  if (utime_us >= bracket->t_1_us) {
    sample.q += static_cast<double>(utime_us - bracket->t_1_us) * 1e-6 * v_1;
    return sample;
  }
  const double h = static_cast<double>(bracket->t_1_us - bracket->t_0_us) * 1e-6;
  const double s = static_cast<double>(utime_us - bracket->t_0_us) * 1e-6 / h;
  // Hermite's cubic: q_0 + s h v_0 + s^2 a + s^3 b.
  const JointVector d = q_1 - q_0;
  const JointVector a = 3 * d - h * (2 * v_0 + v_1), b = h * (v_0 + v_1) - 2 * d;
  sample.q = q_0 + s * (h * v_0 + s * (a + s * b));
  sample.qdot = v_0 + (s / h) * (2 * a + 3 * s * b);
  return sample;
}

std::string JointHistory::DescribeLastRejection() const {
  const Rejection& r = last_rejection_;
  const std::string time = "utime = " + std::to_string(r.utime_us);
  switch (r.verdict) {
    case SampleVerdict::kAccepted:
      return "";
    case SampleVerdict::kDuplicate:
      return time + " repeats the newest joint state, must be later";
    case SampleVerdict::kOutOfOrder:
      return time + " is before the newest joint state's " + std::to_string(r.newest_us) +
             ", must be later";
    case SampleVerdict::kNotFinite:
      return "joint '" + names_[r.joint] + "': position or velocity is not finite at " + time;
    default:
      return "joint_names must name '" + names_[r.joint] +
             "' once, with a position and a velocity for each name, at " + time;
  }
}

}  // namespace visavis
