#include "services/recogniser/refined/looks_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr float kIndependence = AdultLooks::kIndependence;
constexpr double kLeastGain = AdultLooks::kLeastGain;
constexpr int kFewest = 40;      ///< points
constexpr float kNoise = 0.5f;   ///< [levels] of what a point shows
constexpr double kPlain = 0.05;  ///< [levels] contrast that is none
constexpr int kRounds = 2;

}  // namespace

LooksFit::LooksFit(const FacePoints& face) {
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!face.has_generic[i]) continue;
    Point point;
    point.index = i;
    point.p = face.points[i];
    point.mean = face.generic[kFineBand][i];
    point.weight = AdultLooks::Weight(face.doubt[i]);
    for (int k = 0; k < kModes; ++k) point.modes[k] = face.modes[i][static_cast<std::size_t>(k)];
    points_.push_back(point);
  }
}

void LooksFit::FindLights(const std::array<const FaceSamples*, 2>& samples) {
  const double cost = static_cast<double>(a_.squaredNorm() / kIndependence) / 2;
  for (std::size_t e = 0; e < 2; ++e) {
    light_[e] = {};
    if (samples[e] == nullptr) continue;
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    int count = 0;
    for (const Point& point : points_) {
      if (!samples[e]->seen[point.index]) continue;
      const auto w = static_cast<double>(point.weight);
      const auto p = static_cast<double>(point.mean + point.modes.dot(a_));
      const auto v = static_cast<double>(samples[e]->value[point.index]);
      n += w;
      x += w * p;
      y += w * v;
      xx += w * p * p;
      xy += w * p * v;
      yy += w * v * v;
      ++count;
    }
    if (count < kFewest) continue;
    const double var_x = std::max(xx - x * x / n, 1e-9), cov = xy - x * y / n;
    // What is plain shows noise alone, which nothing explains.
    const double var_y = std::max(yy - y * y / n, 0.0);
    const double all = var_y + n * kPlain * kPlain;
    const double gain = std::max(cov / var_x, kLeastGain * std::sqrt(all / var_x));
    const double unexplained = var_y - 2 * gain * cov + gain * gain * var_x;
    light_[e] = {true, static_cast<float>(gain), static_cast<float>((y - gain * x) / n),
                 (var_y - unexplained - gain * gain * cost) / all};
  }
}

double LooksFit::Fit(const std::array<const FaceSamples*, 2>& samples) {
  a_.setZero();
  FindLights(samples);
  const auto sees = [&](std::size_t e, const Point& point) {
    return light_[e].is_known && samples[e]->seen[point.index];
  };
  ModesMatrix H = ModesMatrix::Identity();
  for (const Point& point : points_) {
    const int eyes = sees(0, point) + sees(1, point);
    if (eyes == 0) continue;
    const float weight = kIndependence * point.weight * static_cast<float>(eyes);
    H.noalias() += (weight * point.modes) * point.modes.transpose();
  }
  const auto solver = H.ldlt();
  for (int round = 0; round < kRounds; ++round) {
    Modes g = Modes::Zero();
    for (const Point& point : points_) {
      float off = 0;
      for (std::size_t e = 0; e < 2; ++e) {
        if (sees(e, point))
          off += (samples[e]->value[point.index] - light_[e].offset) / light_[e].gain - point.mean;
      }
      g += kIndependence * point.weight * off * point.modes;
    }
    a_ = solver.solve(g);
    FindLights(samples);
  }
  double likeness = 1;
  bool is_any_known = false;
  for (const Light& light : light_) {
    if (!light.is_known) continue;
    likeness = std::min(likeness, light.likeness);
    is_any_known = true;
  }
  return is_any_known ? likeness : 0;
}

// A point's modes are the same for both eyes: what the eyes say of it is added up first.
void LooksFit::AddTo(const std::array<const FaceSamples*, 2>& samples, const Eigen::Matrix3f& R_CM,
                     float weight, PoseEquations* equations) {
  using Pose = Eigen::Matrix<float, 8, 1>;  // two rows more: fours are added at once
  Eigen::Matrix<float, 8, 8> H_pp = Eigen::Matrix<float, 8, 8>::Zero();
  Eigen::Matrix<float, 8, kModes> H_pa = Eigen::Matrix<float, 8, kModes>::Zero();
  ModesMatrix H_aa = ModesMatrix::Identity();
  Pose g_p = Pose::Zero();
  Modes g_a = -a_;
  for (const Point& point : points_) {
    const float pattern = point.mean + point.modes.dot(a_);
    const Eigen::Vector3f arm = R_CM * point.p;
    Pose across = Pose::Zero();
    float along = 0, off = 0;
    for (std::size_t e = 0; e < 2; ++e) {
      if (!light_[e].is_known || !samples[e]->seen[point.index]) continue;
      const float gain = light_[e].gain;
      const float residual = gain * pattern + light_[e].offset - samples[e]->value[point.index];
      const float variance = gain * gain / point.weight + kNoise * kNoise;
      const float w = weight * kIndependence / (variance + 0.25f * residual * residual);
      Pose row = Pose::Zero();
      row.head<3>() = samples[e]->slope[point.index];
      row.segment<3>(3) = arm.cross(samples[e]->slope[point.index]);
      H_pp.noalias() += (w * row) * row.transpose();
      g_p += (w * residual) * row;
      across -= (w * gain) * row;
      along += w * gain * gain;
      off -= w * gain * residual;
    }
    if (along == 0) continue;
    H_pa.noalias() += across * point.modes.transpose();
    H_aa.noalias() += (along * point.modes) * point.modes.transpose();
    g_a += off * point.modes;
  }
  const auto eliminated = H_aa.ldlt();
  const Eigen::Matrix<float, 6, kModes> to_pose = H_pa.topRows<6>();
  const Eigen::Matrix<float, 6, 6> H =
      H_pp.topLeftCorner<6, 6>() - to_pose * eliminated.solve(to_pose.transpose());
  const Eigen::Matrix<float, 6, 1> g = g_p.head<6>() - to_pose * eliminated.solve(g_a);
  equations->H.triangularView<Eigen::Lower>() += H.cast<double>();
  equations->g += g.cast<double>();
}

}  // namespace visavis
