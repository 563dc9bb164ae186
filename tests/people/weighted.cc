#include "tests/people/weighted.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace visavis {

double WeightedValues::Mean() const {
  double sum = 0, weights = 0;
  for (const auto& [value, weight] : values_) {
    sum += weight * value;
    weights += weight;
  }
  return sum / weights;
}

double WeightedValues::Median() const {
  auto sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  double weights = 0, below = 0;
  for (const auto& [value, weight] : sorted) weights += weight;
  for (const auto& [value, weight] : sorted) {
    below += weight;
    if (below >= 0.5 * weights) return value;
  }
  return sorted.back().first;
}

double WeightedValues::Deviation(double middle, double cap) const {
  constexpr int kRounds = 5;
  double sigma = 1e9;
  for (int round = 0; round < kRounds; ++round) {
    double sum = 0, weights = 0;
    for (const auto& [value, weight] : values_) {
      const double off = std::min(std::abs(value - middle), cap * sigma);
      sum += weight * off * off;
      weights += weight;
    }
    sigma = std::sqrt(sum / weights);
  }
  return sigma;
}

Eigen::MatrixXd PrincipalModes(const Eigen::MatrixXd& deviations, const Eigen::VectorXd& weights,
                               int count) {
  // Fewer columns than rows: A'A has the eigenvalues of A A'.
  const Eigen::MatrixXd A = deviations * weights.cwiseSqrt().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(A.transpose() * A);
  Eigen::MatrixXd modes(A.rows(), count);
  for (int k = 0; k < count; ++k) {
    // A v has the length sqrt(lambda).
    modes.col(k) = A * solver.eigenvectors().col(A.cols() - 1 - k);
    Eigen::Index largest;
    modes.col(k).cwiseAbs().maxCoeff(&largest);
    if (modes(largest, k) < 0) modes.col(k) *= -1;
  }
  return modes;
}

}  // namespace visavis
