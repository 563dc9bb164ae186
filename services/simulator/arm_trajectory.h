#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "common/kinematics/hand_eye.h"
#include "common/kinematics/inverse_kinematics.h"

namespace visavis {

/// Joints of an arm that carries the camera along a path: inverse kinematics at knots, cubics
/// between them. What the camera does is the forward kinematics of these joints, exactly.
class ArmTrajectory {
 public:
  struct Sample {
    JointVector q, qdot;
  };

  /// @param camera_path X_WC at a time [s] since the start
  ArmTrajectory(const HandEye& hand_eye, const Eigen::VectorXd& q_preferred,
                std::function<RigidTransform(double)> camera_path);

  /// Joints at @p time_s. Times must not go back by more than a second.
  /// @throws std::runtime_error where the arm cannot follow the path, naming time and reason.
  Sample At(double time_s);

 private:
  const JointVector& Knot(std::int64_t index);

  HandEye hand_eye_;
  InverseKinematics solver_;
  std::function<RigidTransform(double)> camera_path_;
  Eigen::VectorXd q_start_;
  std::deque<JointVector> knots_;
  static constexpr std::int64_t kNone = INT64_MIN;
  std::int64_t first_knot_{kNone};
};

}  // namespace visavis
