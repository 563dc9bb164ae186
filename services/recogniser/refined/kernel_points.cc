// The data that the kernels take, in the order they want it.
#include <cmath>

#include "services/recogniser/refined/face_kernel.h"
#include "services/recogniser/refined/score_kernel.h"
#include "services/recogniser/refined/score_map.h"

namespace visavis {
namespace {

constexpr float kIndependence = 0.48f;  ///< neighbouring pixels are not independent witnesses
constexpr int kFewestPattern = 20;
constexpr int kLargestDifference = 2 * kMaxContourReach * 2 * 40;

}  // namespace

KernelEye::KernelEye(const EyeGeometry& eye, const EyePose& pose)
    : fx(eye.fx), fy(eye.fy), cx(eye.cx), cy(eye.cy), distance(pose.p_ME.norm()) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      R[i][j] = pose.R_EM(i, j);
      R_CE[i][j] = eye.R_EC(j, i);
      R_CM[i][j] = pose.R_CM(i, j);
    }
    t[i] = pose.p_EM[i];
    p_ME[i] = pose.p_ME[i];
  }
}

void SurfacePoints::Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m) {
  x.push_back(p.x());
  y.push_back(p.y());
  z.push_back(p.z());
  normal_x.push_back(n.x());
  normal_y.push_back(n.y());
  normal_z.push_back(n.z());
  n_dot_p.push_back(n_dot_p_m);
}

void ScorePoints::Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m,
                      int score_shift) {
  SurfacePoints::Add(p, n, n_dot_p_m);
  shift.push_back(score_shift);
}

void ScorePoints::Pad() {
  while (size() % kLanes != 0) Add(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 1, 0);
}

void PatternPoints::Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m,
                        int pattern) {
  SurfacePoints::Add(p, n, n_dot_p_m);
  value.push_back(pattern);
}

void PatternPoints::Pad() {
  while (size() % kLanes != 0) Add(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), 1, 0);
}

double PatternSums::correlation() const {
  if (n < kFewestPattern) return 0;
  const auto product = [&](std::int64_t sum, std::int64_t a, std::int64_t b) {
    return static_cast<double>(n * sum - a * b);
  };
  const double variances = product(xx, x, x) * product(yy, y, y);
  return product(xy, x, y) / std::sqrt(variances + 1);
}

void ContourPoints::Add(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, Edge kind,
                        float point_weight) {
  const auto i = static_cast<std::size_t>(n++);
  x[i] = p.x();
  y[i] = p.y();
  z[i] = p.z();
  normal_x[i] = normal.x();
  normal_y[i] = normal.y();
  normal_z[i] = normal.z();
  edge[i] = static_cast<std::int32_t>(kind);
  weight[i] = point_weight;
}

void ContourPoints::Pad() {
  while (n % kLanes != 0) Add(Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), Edge::kSkin, 0);
}

std::vector<float> ContourLikelihoods() {
  std::vector<float> likelihoods;
  for (int i = 0; i <= kLargestDifference; ++i) {
    likelihoods.push_back(std::exp(-kIndependence / kScorePerNat * static_cast<float>(i)));
  }
  return likelihoods;
}

}  // namespace visavis
