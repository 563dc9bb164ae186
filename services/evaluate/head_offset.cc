#include "services/evaluate/head_offset.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/core/provisional_file.h"

namespace visavis {
namespace {

constexpr int kIterations = 50;
// No scale is smaller, or a pose frozen for half of the frames would pass for perfect agreement.
constexpr double kMinScale_m = 1e-3;
constexpr double kMinScale_rad = 0.3 * M_PI / 180;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Weights of Tukey's biweight for residuals whose median tells their scale.
struct Weights {
  std::vector<double> w;
  double sum{0};
  double rms{0};  ///< of the weighted residuals
};

Weights WeighResiduals(const std::vector<double>& residuals, double min_scale) {
  // 1.4826 times the median absolute deviation is sigma of a normal; 4.685 sigma: 95 % efficiency.
  const double cut = 4.685 * std::max(min_scale, 1.4826 * Median(residuals));
  Weights result;
  double sum_squares = 0;
  for (const double r : residuals) {
    const double u = r / cut;
    const double w = u < 1 ? (1 - u * u) * (1 - u * u) : 0;
    result.w.push_back(w);
    result.sum += w;
    sum_squares += w * r * r;
  }
  result.rms = std::sqrt(sum_squares / result.sum);
  return result;
}

/// Robust mean of points; starts from the median of each coordinate.
Eigen::Vector3d RobustMean(const std::vector<Eigen::Vector3d>& points, double* rms) {
  Eigen::Vector3d mean;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) values[k] = points[k][axis];
    mean[axis] = Median(values);
  }
  for (int i = 0; i < kIterations; ++i) {
    std::vector<double> residuals(points.size());
    for (std::size_t k = 0; k < points.size(); ++k) residuals[k] = (points[k] - mean).norm();
    const Weights weights = WeighResiduals(residuals, kMinScale_m);
    *rms = weights.rms;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) sum += weights.w[k] * points[k];
    mean = sum / weights.sum;
  }
  return mean;
}

/// The rotation with the smallest median angle to all (of at most some hundred candidates).
Eigen::Matrix3d MedoidRotation(const std::vector<Eigen::Matrix3d>& rotations) {
  const std::size_t step = std::max<std::size_t>(1, rotations.size() / 100);
  Eigen::Matrix3d best = rotations[0];
  double best_median = 1e9;
  for (std::size_t i = 0; i < rotations.size(); i += step) {
    std::vector<double> angles(rotations.size());
    for (std::size_t k = 0; k < angles.size(); ++k) {
      angles[k] = LogRotation(rotations[i].transpose() * rotations[k]).norm();
    }
    const double median = Median(angles);
    if (median < best_median) {
      best_median = median;
      best = rotations[i];
    }
  }
  return best;
}

/// Robust mean of rotations: each iteration is a weighted mean in the tangent space of the last.
Eigen::Matrix3d RobustMean(const std::vector<Eigen::Matrix3d>& rotations, double* rms) {
  Eigen::Matrix3d mean = MedoidRotation(rotations);
  for (int i = 0; i < kIterations; ++i) {
    std::vector<Eigen::Vector3d> tangents;
    std::vector<double> residuals;
    for (const auto& R : rotations) {
      tangents.push_back(LogRotation(mean.transpose() * R));
      residuals.push_back(tangents.back().norm());
    }
    const Weights weights = WeighResiduals(residuals, kMinScale_rad);
    *rms = weights.rms;
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < tangents.size(); ++k) step += weights.w[k] * tangents[k];
    mean = mean * ExpRotation(step / weights.sum);
  }
  return mean;
}

[[noreturn]] void Refuse(const std::string& file, const std::string& what) {
  throw std::invalid_argument(file + ": " + what);
}

}  // namespace

HeadOffset FitHeadOffset(const std::vector<TruthAndEstimate>& pairs) {
  if (pairs.size() < static_cast<std::size_t>(kMinPairs)) {
    throw std::invalid_argument(std::to_string(pairs.size()) +
                                " TRACKING frames with truth: must be at least " +
                                std::to_string(kMinPairs) + " to fit a head offset");
  }
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Matrix3d> rotations;
  for (const auto& pair : pairs) {
    const RigidTransform X_TM = pair.X_CT.inverse() * pair.X_CM;
    positions.push_back(X_TM.translation());
    rotations.push_back(X_TM.linear());
  }
  HeadOffset offset;
  const Eigen::Vector3d p_TM = RobustMean(positions, &offset.rms_m);
  offset.X_TM = MakeTransform(RobustMean(rotations, &offset.rms_rad), p_TM);
  offset.num_frames = static_cast<int>(pairs.size());
  return offset;
}

void SaveHeadOffset(const HeadOffset& offset, const std::string& file) {
  const Eigen::Quaterniond q = CanonicalQuaternion(offset.X_TM.linear());
  const Eigen::Vector3d p = offset.X_TM.translation();
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["description"] = "X_TM: pose of the model's head frame in the truth's";
  json["p_m"] = {p.x(), p.y(), p.z()};
  json["q_wxyz"] = {q.w(), q.x(), q.y(), q.z()};
  json["fitted_on"] = offset.source;
  json["frames"] = offset.num_frames;
  json["rms_mm"] = 1e3 * offset.rms_m;
  json["rms_deg"] = 180 / M_PI * offset.rms_rad;
  WriteTextFile(file, json.dump(2) + "\n");
}

HeadOffset LoadHeadOffset(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) Refuse(file, "cannot be read");
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object()) Refuse(file, "must be the JSON that --fit-head-offset writes");
  const auto numbers = [&](const char* key, std::size_t count) {
    const auto value = json.value(key, nlohmann::json());
    const bool good = value.is_array() && value.size() == count &&
                      std::all_of(value.begin(), value.end(),
                                  [](const nlohmann::json& v) { return v.is_number(); });
    if (!good) {
      Refuse(file, std::string(key) + ": " + value.dump() + ": must be " + std::to_string(count) +
                       " numbers");
    }
    return value.get<std::vector<double>>();
  };
  if (json.value("schema", nlohmann::json()) != 1) {
    Refuse(file, "schema: " + json.value("schema", nlohmann::json()).dump() + ": must be 1");
  }
  const auto p = numbers("p_m", 3), q = numbers("q_wxyz", 4);
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (!(std::abs(rotation.norm() - 1) <= 1e-3)) {
    Refuse(file, "q_wxyz: norm " + std::to_string(rotation.norm()) + ": must be 1 within 0.001");
  }
  const Eigen::Vector3d p_TM(p[0], p[1], p[2]);
  if (!(p_TM.norm() <= 1)) {
    Refuse(file, "p_m: norm " + std::to_string(p_TM.norm()) + ": must be at most 1 m");
  }
  HeadOffset offset;
  offset.X_TM = MakeTransform(rotation, p_TM);
  offset.source = file;
  return offset;
}

}  // namespace visavis
