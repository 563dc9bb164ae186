#include "common/kinematics/inverse_kinematics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <kdl/chainiksolverpos_lma.hpp>
#include <limits>
#include <sstream>

#include "common/core/check.h"
#include "common/kinematics/arm_chain.h"

namespace visavis {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;
constexpr int kMaxRounds = 100;
constexpr double kConverged = 1e-10;  // [rad or m] largest step of a joint
constexpr double kMaxNullStep = 0.3;  // [rad or m] a round; larger ones leave the linear range

/// A radian weighs as much as a metre: both residuals matter and are of one size on such arms.
Eigen::Matrix<double, 6, 1> Weights() { return Eigen::Matrix<double, 6, 1>::Ones(); }

/// Part of @p dq that moves no hand: (I - J^+ J) dq.
Eigen::VectorXd NullSpacePart(const Eigen::MatrixXd& J, const Eigen::VectorXd& dq) {
  return dq - J.completeOrthogonalDecomposition().solve(J * dq);
}

}  // namespace

struct InverseKinematics::Impl {
  Impl(const Arm& an_arm, const Eigen::VectorXd& q, const InverseKinematicsOptions& an_options)
      : arm(an_arm),
        options(an_options),
        q_preferred(q),
        solver(arm.chain().kdl, Weights(), 1e-11, 200),
        kdl_start(static_cast<unsigned>(arm.num_joints())),
        kdl_result(kdl_start) {}

  /// The pose alone, near @p q; the residual tells whether it was reached.
  Eigen::VectorXd SolvePose(const KDL::Frame& X_BH, const Eigen::VectorXd& q) {
    kdl_start.data = q;
    solver.CartToJnt(kdl_start, X_BH, kdl_result);
    return kdl_result.data;
  }

  void Measure(const RigidTransform& X_BH, Solution* solution) const {
    const RigidTransform X_reached = arm.ForwardKinematics(solution->q);
    solution->position_error_m = (X_reached.translation() - X_BH.translation()).norm();
    solution->angle_error_rad = LogRotation(X_reached.linear().transpose() * X_BH.linear()).norm();
  }

  std::string ProblemOf(const Solution& solution) const {
    char text[160];
    // Written so that NaN is a problem too.
    if (!(solution.position_error_m <= options.max_position_error_m &&
          solution.angle_error_rad <= options.max_angle_error_rad)) {
      std::snprintf(text, sizeof(text), "%.3f mm and %.4f deg off, must be within %.4f and %.5f",
                    solution.position_error_m * 1e3, solution.angle_error_rad * kDegPerRad,
                    options.max_position_error_m * 1e3, options.max_angle_error_rad * kDegPerRad);
      return text;
    }
    const int i = arm.FindJointBeyondLimits(solution.q);
    if (i < 0) return "";
    const ArmJoint& joint = arm.joints()[i];
    std::snprintf(text, sizeof(text), " = %.4f, must be within %.4f to %.4f", solution.q[i],
                  joint.lower, joint.upper);
    return "joint '" + joint.name + "'" + text;
  }

  Arm arm;
  InverseKinematicsOptions options;
  Eigen::VectorXd q_preferred;
  KDL::ChainIkSolverPos_LMA solver;
  KDL::JntArray kdl_start, kdl_result;
};

InverseKinematics::InverseKinematics(const Arm& arm, const Eigen::VectorXd& q_preferred,
                                     const InverseKinematicsOptions& options) {
  VISAVIS_THROW_UNLESS(q_preferred.size() == arm.num_joints(), q_preferred.size());
  const int beyond = arm.FindJointBeyondLimits(q_preferred);
  VISAVIS_THROW_UNLESS(beyond < 0, arm.joints()[beyond].name);
  impl_ = std::make_unique<Impl>(arm, q_preferred, options);
}

InverseKinematics::~InverseKinematics() = default;

InverseKinematics::Solution InverseKinematics::Solve(
    const RigidTransform& X_BH, const Eigen::Ref<const Eigen::VectorXd>& q_start) {
  VISAVIS_THROW_UNLESS(q_start.size() == impl_->arm.num_joints(), q_start.size());
  const KDL::Frame goal = ToKdl(X_BH);
  Eigen::VectorXd q = impl_->SolvePose(goal, q_start);
  Solution solution{q, 0, 0, ""};
  impl_->Measure(X_BH, &solution);
  solution.problem = impl_->ProblemOf(solution);
  const bool reached = solution.position_error_m <= impl_->options.max_position_error_m &&
                       solution.angle_error_rad <= impl_->options.max_angle_error_rad;
  // Towards the preferred position along the poses' own joint motions, and back onto the pose.
  for (int round = 0; reached && round < kMaxRounds; ++round) {
    Eigen::VectorXd step = NullSpacePart(impl_->arm.Jacobian(q), impl_->q_preferred - q);
    const double size = step.cwiseAbs().maxCoeff();
    if (size < kConverged) break;
    if (size > kMaxNullStep) step *= kMaxNullStep / size;
    q = impl_->SolvePose(goal, q + step);
    Solution moved{q, 0, 0, ""};
    impl_->Measure(X_BH, &moved);
    moved.problem = impl_->ProblemOf(moved);
    if (!moved.ok() && solution.ok()) break;
    solution = moved;
  }
  return solution;
}

JointPath InverseKinematics::SolvePath(const std::vector<RigidTransform>& X_BH) {
  const auto num_poses = static_cast<int>(X_BH.size());
  JointPath path;
  path.q = Eigen::MatrixXd::Constant(impl_->arm.num_joints(), num_poses,
                                     std::numeric_limits<double>::quiet_NaN());
  JointVector q = impl_->q_preferred;
  bool follows = false;  // q is the solution of the pose before
  for (int i = 0; i < num_poses; ++i) {
    Solution solution = Solve(X_BH[i], q);
    if (solution.ok() && follows) {
      Eigen::Index joint = 0;
      const double step = (solution.q - q).cwiseAbs().maxCoeff(&joint);
      if (step > impl_->options.max_joint_step) {
        std::ostringstream problem;
        problem << "joint '" << impl_->arm.joints()[joint].name << "' jumps by " << step
                << ", must move at most " << impl_->options.max_joint_step;
        solution.problem = problem.str();
      }
    }
    follows = solution.ok();
    if (!solution.ok()) {
      path.unreached.push_back({i, solution.problem});
      continue;
    }
    q = solution.q;
    path.q.col(i) = q;
    path.max_position_error_m = std::max(path.max_position_error_m, solution.position_error_m);
    path.max_angle_error_rad = std::max(path.max_angle_error_rad, solution.angle_error_rad);
  }
  return path;
}

std::string JointPath::Describe() const {
  if (unreached.empty()) return "all " + std::to_string(q.cols()) + " poses reached";
  std::string text =
      std::to_string(unreached.size()) + " of " + std::to_string(q.cols()) + " poses not reached: ";
  for (std::size_t i = 0; i < std::min<std::size_t>(unreached.size(), 3); ++i) {
    text += (i == 0 ? "pose " : "; pose ") + std::to_string(unreached[i].index) + ": " +
            unreached[i].reason;
  }
  return text + (unreached.size() > 3 ? "; ..." : "");
}

}  // namespace visavis
