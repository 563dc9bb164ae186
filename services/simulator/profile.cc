#include "services/simulator/profile.h"

#include <algorithm>

#include "common/core/check.h"

namespace visavis {

Profile::Profile(std::initializer_list<std::pair<double, double>> points)
    : Profile(std::vector<std::pair<double, double>>(points)) {}

Profile::Profile(std::vector<std::pair<double, double>> points) {
  VISAVIS_THROW_UNLESS(points.size() >= 2, points.size());
  for (const auto& [x, y] : points) {
    if (!x_.empty()) VISAVIS_THROW_UNLESS(x > x_.back(), x);
    x_.push_back(x);
    y_.push_back(y);
  }
  // Fritsch-Carlson: harmonic mean of the neighbouring secants, zero at extrema and ends.
  slope_.assign(x_.size(), 0.0);
  for (std::size_t i = 1; i + 1 < x_.size(); ++i) {
    const double left = (y_[i] - y_[i - 1]) / (x_[i] - x_[i - 1]);
    const double right = (y_[i + 1] - y_[i]) / (x_[i + 1] - x_[i]);
    if (left * right > 0) slope_[i] = 2 * left * right / (left + right);
  }
  const std::size_t n = x_.size();
  slope_[0] = (y_[1] - y_[0]) / (x_[1] - x_[0]);
  slope_[n - 1] = (y_[n - 1] - y_[n - 2]) / (x_[n - 1] - x_[n - 2]);
}

double Profile::operator()(double x) const {
  if (x <= x_.front()) return y_.front();
  if (x >= x_.back()) return y_.back();
  const auto upper = std::upper_bound(x_.begin(), x_.end(), x);
  const auto i = static_cast<std::size_t>(upper - x_.begin()) - 1;
  const double h = x_[i + 1] - x_[i], t = (x - x_[i]) / h;
  const double a = 1 - t;
  return a * a * ((1 + 2 * t) * y_[i] + t * h * slope_[i]) +
         t * t * ((1 + 2 * a) * y_[i + 1] - a * h * slope_[i + 1]);
}

}  // namespace visavis
