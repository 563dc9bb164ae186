#include "services/calibrate_tool/hand_eye_solver.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <stdexcept>

#include "services/calibrate_tool/hand_eye_start.h"
#include "services/calibrate_tool/least_squares.h"
#include "services/calibrate_tool/planar_start.h"
#include "services/calibrate_tool/pose_block.h"
#include "services/calibrate_tool/projection.h"

namespace visavis {
namespace {

/// A corner in one image.
struct Observation {
  bool is_left;
  Eigen::Vector3d p_T;
  Eigen::Vector2d uv;
  double sigma_px;

  /// For p_C in the right camera's frame.
  template <typename T>
  bool Error(const T* camera, const T* X_CL, const Eigen::Matrix<T, 3, 1>& p_C, T* residual) const {
    const Eigen::Matrix<T, 3, 1> p_K = is_left ? ApplyInverse<T>(X_CL, p_C) : p_C;
    if (!(p_K[2] > 1e-3)) return false;
    const Eigen::Matrix<T, 2, 1> error = ProjectWith<T>(camera, p_K) - uv.cast<T>();
    residual[0] = error[0] / sigma_px;
    residual[1] = error[1] / sigma_px;
    return true;
  }
};

/// The board's pose in the right camera is free.
struct PoseError : Observation {
  explicit PoseError(const Observation& observation) : Observation(observation) {}
  template <typename T>
  bool operator()(const T* X_CT, const T* camera, const T* X_CL, T* residual) const {
    return Error<T>(camera, X_CL, Apply<T>(X_CT, p_T.cast<T>()), residual);
  }
};

/// p_C = X_HC^-1 E^-1 X_BH^-1 X_BT p_T, with the arm's error E in this view: the hand is at X_BH E.
struct ArmError : Observation {
  ArmError(const Observation& observation, const RigidTransform& hand)
      : Observation(observation), X_HB(hand.inverse()) {}
  template <typename T>
  bool operator()(const T* X_HC, const T* X_BT, const T* E, const T* camera, const T* X_CL,
                  T* residual) const {
    const Eigen::Matrix<T, 3, 1> p_B = Apply<T>(X_BT, p_T.cast<T>());
    const Eigen::Matrix<T, 3, 1> p_H =
        (X_HB.linear().cast<T>() * p_B + X_HB.translation().cast<T>()).eval();
    return Error<T>(camera, X_CL, ApplyInverse<T>(X_HC, ApplyInverse<T>(E, p_H)), residual);
  }
  RigidTransform X_HB;
};

/// How much error the arm may have.
struct ArmPrior {
  template <typename T>
  bool operator()(const T* E, T* residual) const {
    for (int i = 0; i < 3; ++i) {
      residual[i] = E[i] / sigma_rad;
      residual[3 + i] = E[3 + i] / sigma_m;
    }
    return true;
  }
  double sigma_rad, sigma_m;
};

/// The rig as the solvers need it: known, so constant blocks.
struct Eyes {
  explicit Eyes(const StereoRig& rig)
      : right(IntrinsicsOf(rig.right)), left(IntrinsicsOf(rig.left)), X_CL(BlockOf(rig.X_CL)) {}

  std::vector<double*> blocks() { return {right.data(), left.data(), X_CL.data()}; }
  double* camera(const Observation& seen) { return seen.is_left ? left.data() : right.data(); }
  /// To be called once all residuals are there.
  void Fix(ceres::Problem* problem) {
    for (double* block : blocks()) {
      if (problem->HasParameterBlock(block)) problem->SetParameterBlockConstant(block);
    }
  }

  Intrinsics right, left;
  PoseBlock X_CL;
};

template <typename Visit>
void ForEachCorner(const Board& board, const StereoView& view, double sigma_px, Visit visit) {
  for (const bool is_left : {false, true}) {
    const BoardView& seen = is_left ? view.left : view.right;
    for (std::size_t i = 0; i < seen.ids.size(); ++i) {
      visit(Observation{is_left, board.corners()[static_cast<std::size_t>(seen.ids[i])],
                        seen.pixels[i], sigma_px});
    }
  }
}

std::optional<RigidTransform> StartBoardPose(const Board& board, const StereoRig& rig,
                                             const StereoView& view) {
  if (const auto X_CT = StartPose(board, view.right, rig.right)) return X_CT;
  if (const auto X_LT = StartPose(board, view.left, rig.left)) return rig.X_CL * *X_LT;
  return std::nullopt;
}

/// Changes of right, left and X_CL's blocks, a column each, that are as likely as one standard
/// deviation of each number. Lens coefficients are left out: most of their scatter is made good by
/// each other's.
Eigen::MatrixXd SpreadOf(const RigUncertainty& sigma, const PoseBlock& X_CL) {
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(2 * kNumIntrinsics + 6, 2 * kNumIntrinsics + 6);
  const auto set = [&spread](int at, const CameraUncertainty& c) {
    spread.diagonal().segment<4>(at) << c.fx, c.fy, c.cx, c.cy;
  };
  set(0, sigma.right);
  set(kNumIntrinsics, sigma.left);
  const auto vector = [](const std::array<double, 3>& v) {
    return Eigen::Vector3d(v[0], v[1], v[2]);
  };
  // The rotation's is about L's axes: see RightJacobian().
  spread.block<3, 3>(2 * kNumIntrinsics, 2 * kNumIntrinsics) =
      RightJacobian(X_CL.head<3>()).inverse() * vector(sigma.X_CL.r_rad).asDiagonal();
  spread.diagonal().tail<3>() = vector(sigma.X_CL.p_m);
  return spread;
}

std::size_t NumCorners(const StereoView& view) {
  return view.right.ids.size() + view.left.ids.size();
}

/// The views that show enough, with the board where the cameras see it.
struct SeenViews {
  std::vector<std::size_t> index;
  std::vector<RigidTransform> X_BH, X_CT;
  double rms_px{0};
};

SeenViews SeeBoards(const Board& board, const StereoRig& rig, const std::vector<ArmView>& views) {
  SeenViews seen;
  double squares = 0;
  std::size_t num_corners = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto start = StartBoardPose(board, rig, views[i].view);
    if (!start) continue;
    double rms_px = 0;
    seen.index.push_back(i);
    seen.X_BH.push_back(views[i].X_BH);
    seen.X_CT.push_back(RefineBoardPose(board, rig, views[i].view, *start, &rms_px));
    squares += rms_px * rms_px * static_cast<double>(NumCorners(views[i].view));
    num_corners += NumCorners(views[i].view);
  }
  seen.rms_px = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, num_corners)));
  return seen;
}

void SetResiduals(const SeenViews& seen, std::size_t num_views, HandEyeCalibration* result) {
  result->residual_m.assign(num_views, std::nan(""));
  result->residual_rad.assign(num_views, std::nan(""));
  double squares_m = 0, squares_rad = 0;
  for (std::size_t i = 0; i < seen.index.size(); ++i) {
    const RigidTransform X_CT = (seen.X_BH[i] * result->X_HC).inverse() * result->X_BT;
    const double error_m = (X_CT.translation() - seen.X_CT[i].translation()).norm();
    const double error_rad = LogRotation(X_CT.linear().transpose() * seen.X_CT[i].linear()).norm();
    result->residual_m[seen.index[i]] = error_m;
    result->residual_rad[seen.index[i]] = error_rad;
    squares_m += error_m * error_m;
    squares_rad += error_rad * error_rad;
  }
  const auto n = static_cast<double>(seen.index.size());
  result->residual_rms_m = std::sqrt(squares_m / n);
  result->residual_rms_rad = std::sqrt(squares_rad / n);
}

}  // namespace

RigidTransform RefineBoardPose(const Board& board, const StereoRig& rig, const StereoView& view,
                               const RigidTransform& X_CT, double* rms_px) {
  Eyes eyes(rig);
  PoseBlock pose = BlockOf(X_CT);
  ceres::Problem problem;
  ForEachCorner(board, view, 1, [&](const Observation& seen) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<PoseError, 2, 6, kNumIntrinsics, 6>(new PoseError(seen)),
        nullptr, pose.data(), eyes.camera(seen), eyes.X_CL.data());
  });
  eyes.Fix(&problem);
  SolveOrThrow("board's pose", &problem);
  double cost = 0;
  problem.Evaluate({}, &cost, nullptr, nullptr, nullptr);
  *rms_px = std::sqrt(2 * cost / static_cast<double>(NumCorners(view)));
  return TransformOf(pose);
}

HandEyeCalibration CalibrateHandEye(const Board& board, const StereoRig& rig,
                                    const std::vector<ArmView>& views,
                                    const HandEyeSettings& settings) {
  const SeenViews seen = SeeBoards(board, rig, views);
  const HandEyeStart start = StartHandEye(seen.X_BH, seen.X_CT);
  HandEyeCalibration result;
  result.start = start.method;
  result.rms_px = seen.rms_px;

  // rms_px is of a corner's distance: sqrt(2) times that of a coordinate. Perfect corners must not
  // make the arm's share of the problem vanish.
  const double sigma_px = std::max(seen.rms_px / std::sqrt(2.0), 0.01);
  Eyes eyes(rig);
  PoseBlock X_HC = BlockOf(start.X_HC), X_BT = BlockOf(start.X_BT);
  std::deque<PoseBlock> errors(seen.index.size(), PoseBlock::Zero());
  ceres::Problem problem;
  for (std::size_t i = 0; i < seen.index.size(); ++i) {
    double* error = errors[i].data();
    ForEachCorner(board, views[seen.index[i]].view, sigma_px, [&](const Observation& corner) {
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<ArmError, 2, 6, 6, 6, kNumIntrinsics, 6>(
              new ArmError(corner, seen.X_BH[i])),
          new ceres::HuberLoss(settings.outlier_px / sigma_px), X_HC.data(), X_BT.data(), error,
          eyes.camera(corner), eyes.X_CL.data());
    });
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<ArmPrior, 6, 6>(
                                 new ArmPrior{settings.arm_sigma_rad, settings.arm_sigma_m}),
                             nullptr, error);
  }
  eyes.Fix(&problem);
  SolveOrThrow("hand-eye", &problem);
  result.X_HC = TransformOf(X_HC);
  result.X_BT = TransformOf(X_BT);
  SetResiduals(seen, views.size(), &result);

  Eigen::MatrixXd covariance = CovarianceOf("hand-eye", {X_HC.data()}, &problem);
  if (settings.rig_uncertainty) {
    std::vector<double*> inputs;
    for (double* block : eyes.blocks())
      if (problem.HasParameterBlock(block)) inputs.push_back(block);
    if (inputs.size() == eyes.blocks().size()) {
      const Eigen::MatrixXd S = SensitivityOf("hand-eye", {X_HC.data()}, inputs, &problem) *
                                SpreadOf(*settings.rig_uncertainty, eyes.X_CL);
      covariance += S * S.transpose();
    }
  }
  const Eigen::Matrix3d J = RightJacobian(X_HC.head<3>());
  result.r_HC_sigma_rad =
      (J * covariance.topLeftCorner<3, 3>() * J.transpose()).diagonal().cwiseSqrt();
  result.p_HC_sigma_m = covariance.bottomRightCorner<3, 3>().diagonal().cwiseSqrt();
  return result;
}

}  // namespace visavis
