#include "services/recogniser/refined/pose_covariance.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

// Found on the simulator (scripts/figures refined: NEES).
constexpr double kShape_m = 0.0006, kShape_rad = 0.009;     ///< where the face is not learned
constexpr double kNoiseShare = 0.006;                       ///< of the equations' inverse
constexpr double kTurned_m = 0.0049, kTurned_rad = 0.0041;  ///< a radian from the mean view
constexpr double kLearned_rad = 0.0071;
constexpr double kFarTurned_rad = 0.07;  ///< a cubed radian from there: the looks hardly tell more
constexpr double kHiddenDepth_m = 0.010, kHidden_m = 0.002, kHidden_rad = 0.03;  ///< of all
constexpr double kSettling = 1;  ///< frames: the learned frame is as uncertain as kShape before

void AddIndependent(double sigma_m, double sigma_rad, Matrix6d* covariance) {
  covariance->diagonal().head<3>().array() += sigma_m * sigma_m;
  covariance->diagonal().tail<3>().array() += sigma_rad * sigma_rad;
}

}  // namespace

void PoseCovariance::Forget() {
  sum_.setZero();
  count_ = 0;
}

void PoseCovariance::Learn(const Eigen::Vector3d& direction) {
  sum_ += direction;
  ++count_;
}

Matrix6d PoseCovariance::OfAnyFace(const Matrix6d& information) {
  Matrix6d covariance = information.inverse();
  AddIndependent(kShape_m, kShape_rad, &covariance);
  return covariance;
}

Matrix6d PoseCovariance::OfLearnedFace(const Matrix6d& information,
                                       const Eigen::Vector3d& direction) const {
  if (count_ == 0) return OfAnyFace(information);
  Matrix6d covariance = kNoiseShare * information.inverse();
  const double turned_rad = std::acos(std::clamp(sum_.normalized().dot(direction), -1.0, 1.0));
  const double far_rad = kFarTurned_rad * turned_rad * turned_rad * turned_rad;
  AddIndependent(kTurned_m * turned_rad,
                 std::hypot(kLearned_rad, kTurned_rad * turned_rad, far_rad), &covariance);
  const double unsettled = kSettling / (kSettling + count_);
  AddIndependent(unsettled * kShape_m, unsettled * kShape_rad, &covariance);
  return covariance;
}

Matrix6d WithHidden(const Matrix6d& covariance, double hidden, const Eigen::Vector3d& sight) {
  Matrix6d more = covariance;
  AddIndependent(hidden * kHidden_m, hidden * kHidden_rad, &more);
  const double depth_m = hidden * kHiddenDepth_m;
  more.topLeftCorner<3, 3>() += depth_m * depth_m * sight * sight.transpose();
  return more;
}

Matrix6d WithLever(const Matrix6d& covariance, const Eigen::Vector3d& p_MR_C) {
  Matrix6d lever = Matrix6d::Identity();
  lever.topRightCorner<3, 3>() << 0, p_MR_C.z(), -p_MR_C.y(),  //
      -p_MR_C.z(), 0, p_MR_C.x(),                              //
      p_MR_C.y(), -p_MR_C.x(), 0;
  return lever * covariance * lever.transpose();
}

}  // namespace visavis
