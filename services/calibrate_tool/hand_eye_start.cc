#include "services/calibrate_tool/hand_eye_start.h"

#include <Eigen/SVD>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace visavis {
namespace {

constexpr std::size_t kMinViews = 4;
constexpr double kMinTurnRad = 0.1;  // about the second axis, root mean square

cv::Mat ToMat(const Eigen::Matrix3d& R) {
  cv::Mat result(3, 3, CV_64F);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) result.at<double>(i, k) = R(i, k);
  return result;
}

cv::Mat ToMat(const Eigen::Vector3d& p) {
  cv::Mat result(3, 1, CV_64F);
  for (int i = 0; i < 3; ++i) result.at<double>(i) = p[i];
  return result;
}

Eigen::Vector3d MeanTranslation(const std::vector<RigidTransform>& poses) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const auto& X : poses) mean += X.translation() / static_cast<double>(poses.size());
  return mean;
}

/// Mean rotation: nearest to the mean matrix.
Eigen::Matrix3d MeanRotation(const std::vector<RigidTransform>& poses) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const auto& X : poses) sum += X.linear();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) *= -1;
  return U * svd.matrixV().transpose();
}

void RequireTurns(const std::vector<RigidTransform>& X_BH) {
  if (X_BH.size() < kMinViews) {
    throw std::invalid_argument("views: " + std::to_string(X_BH.size()) +
                                " with board and arm: must be at least " +
                                std::to_string(kMinViews));
  }
  const Eigen::Matrix3d R_mean = MeanRotation(X_BH);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& X : X_BH) {
    const Eigen::Vector3d r = LogRotation(R_mean.transpose() * X.linear());
    scatter += r * r.transpose() / static_cast<double>(X_BH.size());
  }
  const double second_rad = std::sqrt(scatter.jacobiSvd().singularValues()[1]);
  if (second_rad >= kMinTurnRad) return;
  std::ostringstream text;
  text << "hand turned by " << second_rad * 180 / M_PI
       << " deg about the second of its axes: must be at least " << kMinTurnRad * 180 / M_PI
       << " deg about two: tilt the hand to all sides";
  throw std::invalid_argument(text.str());
}

}  // namespace

HandEyeStart StartHandEye(const std::vector<RigidTransform>& X_BH,
                          const std::vector<RigidTransform>& X_CT) {
  RequireTurns(X_BH);
  std::vector<cv::Mat> R_BH, p_BH, R_CT, p_CT;
  for (std::size_t i = 0; i < X_BH.size(); ++i) {
    R_BH.push_back(ToMat(Eigen::Matrix3d(X_BH[i].linear())));
    p_BH.push_back(ToMat(Eigen::Vector3d(X_BH[i].translation())));
    R_CT.push_back(ToMat(Eigen::Matrix3d(X_CT[i].linear())));
    p_CT.push_back(ToMat(Eigen::Vector3d(X_CT[i].translation())));
  }
  const std::pair<const char*, cv::HandEyeCalibrationMethod> methods[] = {
      {"Tsai", cv::CALIB_HAND_EYE_TSAI},
      {"Park", cv::CALIB_HAND_EYE_PARK},
      {"Horaud", cv::CALIB_HAND_EYE_HORAUD},
      {"Andreff", cv::CALIB_HAND_EYE_ANDREFF},
      {"Daniilidis", cv::CALIB_HAND_EYE_DANIILIDIS}};
  HandEyeStart best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [name, method] : methods) {
    cv::Mat R, p;
    try {
      cv::calibrateHandEye(R_BH, p_BH, R_CT, p_CT, R, p, method);
    } catch (const cv::Exception&) {
      continue;  // another may do
    }
    Eigen::Matrix3d R_HC;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) R_HC(i, k) = R.at<double>(i, k);
    const Eigen::Vector3d p_HC(p.at<double>(0), p.at<double>(1), p.at<double>(2));
    if (!R_HC.allFinite() || !p_HC.allFinite() || std::abs(R_HC.determinant() - 1) > 0.01) continue;
    HandEyeStart start{MakeTransform(Eigen::Quaterniond(R_HC), p_HC), {}, name};
    std::vector<RigidTransform> X_BT;
    for (std::size_t i = 0; i < X_BH.size(); ++i) X_BT.push_back(X_BH[i] * start.X_HC * X_CT[i]);
    start.X_BT = MakeTransform(MeanRotation(X_BT), MeanTranslation(X_BT));
    double scatter = 0;
    for (const auto& X : X_BT)
      scatter += (X.translation() - start.X_BT.translation()).squaredNorm();
    if (!(scatter < least)) continue;
    least = scatter;
    best = start;
  }
  if (best.method.empty()) throw std::invalid_argument("views: no hand-eye method has an answer");
  return best;
}

}  // namespace visavis
