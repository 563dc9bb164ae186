#pragma once

#include <ceres/problem.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace visavis {

/// Solves a problem to convergence, in one thread and without a word.
/// @throws std::invalid_argument "WHAT: ..." where it does not converge.
void SolveOrThrow(const std::string& what, ceres::Problem* problem);

/// Covariance of @p blocks one after another (their tangents), all other parameters free too, for
/// residuals of unit variance. Constant blocks are not allowed in it.
/// @throws std::invalid_argument "WHAT: ..." where the data does not determine all parameters.
Eigen::MatrixXd CovarianceOf(const std::string& what, const std::vector<const double*>& blocks,
                             ceres::Problem* problem);

/// How the solution's @p blocks follow where @p inputs, constant blocks of the problem, change: one
/// row a number of the blocks, one column a number of the inputs.
/// @throws as CovarianceOf().
Eigen::MatrixXd SensitivityOf(const std::string& what, const std::vector<const double*>& blocks,
                              const std::vector<double*>& inputs, ceres::Problem* problem);

}  // namespace visavis
