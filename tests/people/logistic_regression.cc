#include "tests/people/logistic_regression.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/core/check.h"

namespace visavis {
namespace {

constexpr int kMostSteps = 200;
constexpr double kShortest = 1.0 / (1 << 20);  ///< of a step, what is tried
constexpr double kSettled = 1e-9;              ///< a step below it is the last

/// The logarithm of 1 + exp(x), without overflow.
double LogOnePlusExp(double x) { return std::max(x, 0.0) + std::log1p(std::exp(-std::abs(x))); }

/// What is maximised; concave.
double Merit(const Eigen::MatrixXd& features, const Eigen::VectorXd& truths, double ridge,
             const Eigen::VectorXd& b) {
  const Eigen::VectorXd log_odds = features * b;
  return truths.dot(log_odds) - log_odds.unaryExpr(&LogOnePlusExp).sum() -
         0.5 * ridge * b.squaredNorm();
}

Eigen::VectorXd NewtonStep(const Eigen::MatrixXd& features, const Eigen::VectorXd& truths,
                           double ridge, const Eigen::VectorXd& b) {
  const Eigen::ArrayXd p = 1 / (1 + (-(features * b).array()).exp());
  const Eigen::VectorXd gradient = features.transpose() * (truths - p.matrix()) - ridge * b;
  Eigen::MatrixXd hessian = features.transpose() * (p * (1 - p)).matrix().asDiagonal() * features;
  hessian.diagonal().array() += ridge;
  return hessian.ldlt().solve(gradient);
}

}  // namespace

Eigen::VectorXd LogisticRegression(const Eigen::MatrixXd& features, const Eigen::VectorXd& truths,
                                   double ridge) {
  VISAVIS_THROW_UNLESS(features.rows() == truths.size(), truths.size());
  VISAVIS_THROW_UNLESS(features.allFinite(), features);
  VISAVIS_THROW_UNLESS((truths.array() == 0 || truths.array() == 1).all(), truths);
  VISAVIS_THROW_UNLESS(ridge > 0, ridge);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(features.cols());
  double merit = Merit(features, truths, ridge, b);
  for (int i = 0; i < kMostSteps; ++i) {
    const Eigen::VectorXd step = NewtonStep(features, truths, ridge, b);
    // Far from the maximum a whole step may lead past it.
    double length = 1, next = Merit(features, truths, ridge, b + step);
    while (!(next >= merit) && length > kShortest) {
      length /= 2;
      next = Merit(features, truths, ridge, b + length * step);
    }
    if (!(next >= merit)) break;  // by rounding alone: it is there
    b += length * step;
    merit = next;
    if (step.norm() < kSettled * (1 + b.norm())) break;
  }
  return b;
}

}  // namespace visavis
