#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/kinematics/arm.h"

namespace visavis {

struct InverseKinematicsOptions {
  double max_position_error_m{1e-6};  ///< residual above which a pose counts as not reached
  double max_angle_error_rad{1e-6};   ///< likewise
  double max_joint_step{0.5};         ///< [rad or m] between neighbours of a path: no jumps
};

/// A pose of a path that has no acceptable joint position.
struct UnreachedPose {
  int index;           ///< in the path
  std::string reason;  ///< e.g. "31.20 mm and 0.41 deg off", "joint 'j4' = -2.31, must be ..."
};

struct JointPath {
  Eigen::MatrixXd q;  ///< joints x poses; NaN in the columns of unreached poses
  std::vector<UnreachedPose> unreached;
  double max_position_error_m{0};  ///< over the reached poses
  double max_angle_error_rad{0};   ///< likewise

  /// "all 300 poses reached" or, for at most three of them, which were not and why.
  std::string Describe() const;
};

/// Joint positions that put the hand where it is wanted, by KDL's Levenberg-Marquardt solver. An
/// arm with joints to spare takes, of all solutions near the start, the one nearest to the
/// preferred position: the result then is a smooth function of the pose alone, so that a periodic
/// path of the hand is a periodic path of the joints.
///
/// For simulation and planning: it allocates, and one object serves one thread.
class InverseKinematics {
 public:
  /// @param q_preferred  within the limits; the middle of a good working posture.
  /// @throws std::invalid_argument if it has another size or lies outside the limits.
  InverseKinematics(const Arm& arm, const Eigen::VectorXd& q_preferred,
                    const InverseKinematicsOptions& options = {});
  ~InverseKinematics();

  struct Solution {
    JointVector q;
    double position_error_m;
    double angle_error_rad;
    std::string problem;  ///< empty: reached within limits
    bool ok() const { return problem.empty(); }
  };

  /// Solves ForwardKinematics(q) = X_BH, starting from @p q_start.
  Solution Solve(const RigidTransform& X_BH, const Eigen::Ref<const Eigen::VectorXd>& q_start);

  /// Solves a path pose by pose, each from the one before it, the first from the preferred
  /// position. Does not stop at a failing pose.
  JointPath SolvePath(const std::vector<RigidTransform>& X_BH);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace visavis
