#pragma once

#include <Eigen/Core>

namespace visavis {

/// The coefficients b of p = 1 / (1 + exp(-features b)), the probability that a sample is true: b
/// maximises the logarithm of how likely the samples are, less @p ridge / 2 |b|^2.
/// @param features a sample a row; a column of ones, where a constant is wanted
/// @param truths of each sample 1 or 0
/// @param ridge above 0: with it b is unique and finite, though a plane part the true and the false
/// @throws std::invalid_argument on other shapes or values, and on features that are not finite
Eigen::VectorXd LogisticRegression(const Eigen::MatrixXd& features, const Eigen::VectorXd& truths,
                                   double ridge);

}  // namespace visavis
