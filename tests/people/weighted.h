#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace visavis {

/// Values, each with how much it counts.
class WeightedValues {
 public:
  void Add(double value, double weight) { values_.emplace_back(value, weight); }
  bool empty() const { return values_.empty(); }
  double Mean() const;
  double Median() const;
  /// Standard deviation about @p middle; of each value at most @p cap standard deviations count.
  double Deviation(double middle, double cap) const;

 private:
  std::vector<std::pair<double, double>> values_;
};

/// The @p count strongest principal components of the columns of @p deviations, which count by
/// @p weights (of sum 1): unit vector times standard deviation, a column each.
Eigen::MatrixXd PrincipalModes(const Eigen::MatrixXd& deviations, const Eigen::VectorXd& weights,
                               int count);

}  // namespace visavis
