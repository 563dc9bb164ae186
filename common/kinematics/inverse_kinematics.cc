#include "common/kinematics/inverse_kinematics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <kdl/chainiksolverpos_lma.hpp>
#include <limits>
#include <sstream>

#include "common/core/check.h"
#include "common/geometry/head_angles.h"
#include "common/kinematics/arm_chain.h"

namespace visavis {
namespace {

constexpr double kDegPerRad = 180.0 / M_PI;
constexpr int kMaxRounds = 200;
constexpr double kConverged = 1e-11;  // [rad or m] largest step of a joint
constexpr double kMaxStep = 0.2;      // [rad or m] a round; larger ones leave the linear range

/// A radian weighs as much as a metre: both residuals matter and are of one size on such arms.
Eigen::Matrix<double, 6, 1> Weights() { return Eigen::Matrix<double, 6, 1>::Ones(); }

/// Scales @p step so that no joint moves by more than kMaxStep.
Eigen::VectorXd Limited(const Eigen::VectorXd& step) {
  const double size = step.cwiseAbs().maxCoeff();
  return size > kMaxStep ? Eigen::VectorXd(step * (kMaxStep / size)) : step;
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
    Eigen::VectorXd result = kdl_result.data;
    for (int i = 0; i < arm.num_joints(); ++i) {  // far from the start it may have wound up
      const ArmJoint& joint = arm.joints()[i];
      if (joint.type != JointType::kRevolute) continue;
      result[i] -=
          2 * M_PI * std::round((result[i] - (joint.lower + joint.upper) / 2) / (2 * M_PI));
    }
    return result;
  }

  /// Pose error at q, in B: position over rotation vector.
  Vector6d Error(const RigidTransform& X_BH, const Eigen::VectorXd& q) const {
    const RigidTransform X = arm.ForwardKinematics(q);
    Vector6d error;
    error << X_BH.translation() - X.translation(),
        LogRotation(X_BH.linear() * X.linear().transpose());
    return error;
  }

  Solution Judge(const RigidTransform& X_BH, const Eigen::VectorXd& q) const {
    const Vector6d error = Error(X_BH, q);
    Solution solution{q, error.head<3>().norm(), error.tail<3>().norm(), ""};
    solution.problem = ProblemOf(solution);
    return solution;
  }

  /// Newton's method from a solution: J^+ of what KDL leaves (its angles have a dead zone of 1e-6)
  /// plus the way to the preferred position along (I - J^+ J), the motions that keep the pose.
  Eigen::VectorXd Refine(const RigidTransform& X_BH, Eigen::VectorXd q) const {
    for (int round = 0; round < kMaxRounds; ++round) {
      const Eigen::MatrixXd J = arm.Jacobian(q);
      const auto decomposition = J.completeOrthogonalDecomposition();
      const Eigen::VectorXd wish = q_preferred - q;
      const Eigen::VectorXd step = Limited(decomposition.solve(Error(X_BH, q))) +
                                   Limited(wish - decomposition.solve(J * wish));
      q += step;
      if (step.cwiseAbs().maxCoeff() < kConverged) break;
    }
    return q;
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
  const Eigen::VectorXd q = impl_->SolvePose(ToKdl(X_BH), q_start);
  const Solution found = impl_->Judge(X_BH, q);
  const Solution refined = impl_->Judge(X_BH, impl_->Refine(X_BH, q));
  return refined.ok() || !found.ok() ? refined : found;
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
