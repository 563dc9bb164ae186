#include "services/evaluate/error_statistics.h"

#include <algorithm>
#include <cmath>

namespace visavis {

std::optional<Statistics> ComputeStatistics(const std::vector<double>& errors) {
  if (errors.empty()) return std::nullopt;
  Statistics s;
  for (const double e : errors) {
    s.rmse += e * e;
    s.mean += std::abs(e);
    s.max = std::max(s.max, std::abs(e));
    s.bias += e;
  }
  const auto n = static_cast<double>(errors.size());
  s.rmse = std::sqrt(s.rmse / n);
  s.mean /= n;
  s.bias /= n;
  return s;
}

ErrorStatistics ComputeErrorStatistics(const std::vector<RecognitionError>& errors) {
  ErrorStatistics result;
  std::vector<double> values(errors.size());
  const auto compute = [&](auto component) {
    std::transform(errors.begin(), errors.end(), values.begin(), component);
    return ComputeStatistics(values);
  };
  for (int i = 0; i < 3; ++i) {
    result.position_m[i] = compute([i](const RecognitionError& e) { return e.position[i]; });
    result.angle_rad[i] = compute([i](const RecognitionError& e) { return e.angles[i]; });
  }
  result.position_norm_m = compute([](const RecognitionError& e) { return e.position.norm(); });
  result.total_angle_rad = compute([](const RecognitionError& e) { return e.total_angle; });
  if (errors.empty()) return result;
  const auto length = [](const std::array<std::optional<Statistics>, 3>& s) {
    return std::hypot(s[0]->bias, s[1]->bias, s[2]->bias);
  };
  result.position_norm_m->bias = length(result.position_m);
  result.total_angle_rad->bias = length(result.angle_rad);
  return result;
}

std::optional<double> Quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace visavis
