#include "services/calibrate_tool/stereo_solver.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "services/calibrate_tool/least_squares.h"
#include "services/calibrate_tool/planar_start.h"
#include "services/calibrate_tool/pose_block.h"
#include "services/calibrate_tool/projection.h"

namespace visavis {
namespace {

/// A corner in the right image: p_C = X_CT p_T.
struct RightError {
  template <typename T>
  bool operator()(const T* camera, const T* X_CT, T* residual) const {
    const Eigen::Matrix<T, 3, 1> p_C = Apply<T>(X_CT, p_T.cast<T>());
    if (!(p_C[2] > 1e-3)) return false;
    const Eigen::Matrix<T, 2, 1> error = ProjectWith<T>(camera, p_C) - uv.cast<T>();
    residual[0] = error[0];
    residual[1] = error[1];
    return true;
  }
  Eigen::Vector3d p_T;
  Eigen::Vector2d uv;
};

/// ... and in the left one: p_L = X_CL^-1 X_CT p_T.
struct LeftError {
  template <typename T>
  bool operator()(const T* camera, const T* X_CT, const T* X_CL, T* residual) const {
    const Eigen::Matrix<T, 3, 1> p_L = ApplyInverse<T>(X_CL, Apply<T>(X_CT, p_T.cast<T>()));
    if (!(p_L[2] > 1e-3)) return false;
    const Eigen::Matrix<T, 2, 1> error = ProjectWith<T>(camera, p_L) - uv.cast<T>();
    residual[0] = error[0];
    residual[1] = error[1];
    return true;
  }
  Eigen::Vector3d p_T;
  Eigen::Vector2d uv;
};

std::vector<int> FixedCoefficients(DistortionModel model) {
  switch (model) {
    case DistortionModel::kNone:
      return {4, 5, 6, 7, 8};
    case DistortionModel::kRadial:
      return {6, 7, 8};
    case DistortionModel::kPlumbBob4:
      return {8};
    case DistortionModel::kPlumbBob5:
      break;
  }
  return {};
}

class StereoProblem {
 public:
  StereoProblem(const Board& board, const std::vector<StereoView>& views,
                const StereoSettings& settings)
      : board_(board), views_(views), settings_(settings), poses_(views.size()) {
    Start();
    Build();
  }

  StereoCalibration Solve() {
    SolveOrThrow("stereo", &problem_);
    StereoCalibration result;
    result.rig.right = PinholeOf(right_, settings_.width, settings_.height);
    result.rig.left = PinholeOf(left_, settings_.left_width, settings_.left_height);
    result.rig.X_CL = TransformOf(X_CL_);
    for (const auto& pose : poses_)
      result.X_CT.push_back(pose ? TransformOf(*pose) : RigidTransform::Identity());
    SetResiduals(&result);
    SetSigmas(&result);
    return result;
  }

 private:
  const Eigen::Vector3d& Corner(int id) const {
    return board_.corners()[static_cast<std::size_t>(id)];
  }

  void Start() {
    std::vector<const BoardView*> right, left;
    for (const StereoView& view : views_) {
      right.push_back(&view.right);
      left.push_back(&view.left);
    }
    const Pinhole right_camera = StartCamera(board_, right, settings_.width, settings_.height);
    const Pinhole left_camera =
        StartCamera(board_, left, settings_.left_width, settings_.left_height);
    right_ = IntrinsicsOf(right_camera);
    left_ = IntrinsicsOf(left_camera);
    std::vector<std::optional<RigidTransform>> X_CT, X_LT;
    for (const StereoView& view : views_) {
      X_CT.push_back(StartPose(board_, view.right, right_camera));
      X_LT.push_back(StartPose(board_, view.left, left_camera));
    }
    const RigidTransform X_CL = StartRelation(X_CT, X_LT);
    X_CL_ = BlockOf(X_CL);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (X_CT[i]) {
        poses_[i] = BlockOf(*X_CT[i]);
      } else if (X_LT[i]) {
        poses_[i] = BlockOf(X_CL * *X_LT[i]);
      }
    }
  }

  /// Of all views' X_CL, the one that the others agree with best.
  static RigidTransform StartRelation(const std::vector<std::optional<RigidTransform>>& X_CT,
                                      const std::vector<std::optional<RigidTransform>>& X_LT) {
    std::vector<RigidTransform> all;
    for (std::size_t i = 0; i < X_CT.size(); ++i)
      if (X_CT[i] && X_LT[i]) all.push_back(*X_CT[i] * X_LT[i]->inverse());
    if (all.empty())
      throw std::invalid_argument("views: none shows the board in both images: some must");
    const RigidTransform* best = nullptr;
    double best_median = 0;
    for (const RigidTransform& candidate : all) {
      std::vector<double> distances;
      for (const RigidTransform& other : all) {
        distances.push_back((candidate.translation() - other.translation()).norm() +
                            LogRotation(candidate.linear().transpose() * other.linear()).norm());
      }
      const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
      std::nth_element(distances.begin(), middle, distances.end());
      if (best && *middle >= best_median) continue;
      best = &candidate;
      best_median = *middle;
    }
    return *best;
  }

  void Build() {
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!poses_[i]) continue;
      double* pose = poses_[i]->data();
      const BoardView &right = views_[i].right, &left = views_[i].left;
      for (std::size_t k = 0; k < right.ids.size(); ++k) {
        problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<RightError, 2, kNumIntrinsics, 6>(
                                      new RightError{Corner(right.ids[k]), right.pixels[k]}),
                                  new ceres::HuberLoss(settings_.outlier_px), right_.data(), pose);
      }
      for (std::size_t k = 0; k < left.ids.size(); ++k) {
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<LeftError, 2, kNumIntrinsics, 6, 6>(
                new LeftError{Corner(left.ids[k]), left.pixels[k]}),
            new ceres::HuberLoss(settings_.outlier_px), left_.data(), pose, X_CL_.data());
      }
      num_corners_ += right.ids.size() + left.ids.size();
    }
    const std::vector<int> fixed = FixedCoefficients(settings_.distortion);
    if (fixed.empty()) return;
    for (double* camera : {right_.data(), left_.data()})
      problem_.SetManifold(camera, new ceres::SubsetManifold(kNumIntrinsics, fixed));
  }

  void SetResiduals(StereoCalibration* result) const {
    const StereoRig& rig = result->rig;
    const RigidTransform X_LC = rig.X_CL.inverse();
    double sum = 0;
    const auto rms = [&](const BoardView& view, const Pinhole& camera, const RigidTransform& X) {
      double squares = 0;
      for (std::size_t k = 0; k < view.ids.size(); ++k)
        squares += (Project(camera, X * Corner(view.ids[k])).uv - view.pixels[k]).squaredNorm();
      sum += squares;
      return std::sqrt(squares / static_cast<double>(view.ids.size()));
    };
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const bool used = poses_[i].has_value();
      result->right_rms_px.push_back(used ? rms(views_[i].right, rig.right, result->X_CT[i])
                                          : std::nan(""));
      result->left_rms_px.push_back(used ? rms(views_[i].left, rig.left, X_LC * result->X_CT[i])
                                         : std::nan(""));
    }
    result->rms_px = std::sqrt(sum / static_cast<double>(num_corners_));
  }

  void SetSigmas(StereoCalibration* result) {
    const Eigen::MatrixXd covariance =
        CovarianceOf("stereo", {right_.data(), left_.data(), X_CL_.data()}, &problem_);
    const std::vector<int> fixed = FixedCoefficients(settings_.distortion);
    const auto num_free_intrinsics = static_cast<Eigen::Index>(kNumIntrinsics - fixed.size());
    const auto num_poses = std::count_if(poses_.begin(), poses_.end(),
                                         [](const auto& pose) { return pose.has_value(); });
    // Two numbers a corner; the parameters take their share of the scatter.
    const double num_free = 2.0 * static_cast<double>(num_corners_) -
                            static_cast<double>(2 * num_free_intrinsics + 6 + 6 * num_poses);
    double cost = 0;
    problem_.Evaluate({}, &cost, nullptr, nullptr, nullptr);
    const double sigma = std::sqrt(2 * cost / std::max(1.0, num_free));
    const Eigen::VectorXd sigmas = sigma * covariance.diagonal().cwiseSqrt();
    result->right_sigma = SigmaOf(sigmas.head(num_free_intrinsics), fixed);
    result->left_sigma = SigmaOf(sigmas.segment(num_free_intrinsics, num_free_intrinsics), fixed);
    // A small turn about L's axes changes the rotation vector r by Jr(r)^-1 of it.
    const Eigen::Matrix3d block =
        covariance.block<3, 3>(2 * num_free_intrinsics, 2 * num_free_intrinsics);
    const Eigen::Matrix3d J = RightJacobian(X_CL_.head<3>());
    result->r_CL_sigma_rad = sigma * (J * block * J.transpose()).diagonal().cwiseSqrt();
    result->p_CL_sigma_m = sigmas.tail<3>();
  }

  static CameraSigma SigmaOf(const Eigen::VectorXd& free, const std::vector<int>& fixed) {
    std::array<double, kNumIntrinsics> all{};
    Eigen::Index next = 0;
    for (int i = 0; i < kNumIntrinsics; ++i)
      if (std::find(fixed.begin(), fixed.end(), i) == fixed.end()) all[i] = free[next++];
    return {all[0], all[1], all[2], all[3], {all[4], all[5], all[6], all[7], all[8]}};
  }

  const Board& board_;
  const std::vector<StereoView>& views_;
  const StereoSettings settings_;
  Intrinsics right_, left_;
  PoseBlock X_CL_;
  std::vector<std::optional<PoseBlock>> poses_;
  std::size_t num_corners_{0};
  ceres::Problem problem_;
};

}  // namespace

StereoCalibration CalibrateStereo(const Board& board, const std::vector<StereoView>& views,
                                  const StereoSettings& settings) {
  return StereoProblem(board, views, settings).Solve();
}

}  // namespace visavis
