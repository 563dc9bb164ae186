#include "services/arm_state/velocity_estimator.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace visavis {

std::optional<JointVector> VelocityEstimator::Add(std::int64_t utime_us, const JointVector& q) {
  ring_[next_] = {utime_us, q};
  next_ = (next_ + 1) % kCapacity;
  size_ = std::min(size_ + 1, kCapacity);
  // Times before the newest, in windows, so that the normal equations are well scaled.
  const auto age = [&](int i) {
    return -1e-6 * static_cast<double>(utime_us - Back(i).utime_us) / window_s_;
  };
  if (size_ == 1) return std::nullopt;
  if (size_ == 2) return ((q - Back(1).q) / (-age(1) * window_s_)).eval();

  int n = 3;
  while (n < size_ && -age(n) <= 1) ++n;
  const double scale = -1 / age(n - 1);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (int i = 0; i < n; ++i) {
    const double s = age(i) * scale;
    const Eigen::Vector3d powers(1, s, s * s);
    normal += powers * powers.transpose();
  }
  // The slope is a weighted sum of the positions: the second row of normal^-1 times the powers.
  const Eigen::Vector3d row = normal.ldlt().solve(Eigen::Vector3d::UnitY());
  JointVector slope = JointVector::Zero(q.size());
  for (int i = 0; i < n; ++i) {
    const double s = age(i) * scale;
    slope += (row[0] + s * (row[1] + s * row[2])) * (Back(i).q - q);  // weights sum to 0
  }
  return (slope * (scale / window_s_)).eval();
}

}  // namespace visavis
