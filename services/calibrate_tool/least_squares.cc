#include "services/calibrate_tool/least_squares.h"

#include <ceres/crs_matrix.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <stdexcept>

namespace visavis {

void SolveOrThrow(const std::string& what, ceres::Problem* problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_SCHUR;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  if (!summary.IsSolutionUsable())
    throw std::invalid_argument(what + ": does not converge: " + summary.message);
}

Eigen::MatrixXd CovarianceOf(const std::string& what, const std::vector<const double*>& blocks,
                             ceres::Problem* problem) {
  // The normal equations of all free parameters; a few hundred, so dense will do.
  std::vector<double*> all;
  problem->GetParameterBlocks(&all);
  ceres::Problem::EvaluateOptions options;
  std::map<const double*, int> column_of;
  int num_columns = 0;
  for (double* block : all) {
    if (problem->IsParameterBlockConstant(block)) continue;
    options.parameter_blocks.push_back(block);
    column_of[block] = num_columns;
    num_columns += problem->ParameterBlockTangentSize(block);
  }
  ceres::CRSMatrix J;
  problem->Evaluate(options, nullptr, nullptr, nullptr, &J);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(num_columns, num_columns);
  for (int row = 0; row < J.num_rows; ++row) {
    for (int a = J.rows[row]; a < J.rows[row + 1]; ++a)
      for (int b = J.rows[row]; b < J.rows[row + 1]; ++b)
        normal(J.cols[a], J.cols[b]) += J.values[a] * J.values[b];
  }
  std::vector<int> wanted;
  for (const double* block : blocks) {
    for (int i = 0; i < problem->ParameterBlockTangentSize(block); ++i)
      wanted.push_back(column_of.at(block) + i);
  }
  // Scaled to a unit diagonal, so that its condition tells what the data determines.
  const Eigen::VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const auto factors = scaled.ldlt();
  const Eigen::VectorXd pivots = factors.vectorD();
  if (factors.info() != Eigen::Success || !(pivots.minCoeff() > 1e-13 * pivots.maxCoeff()))
    throw std::invalid_argument(what +
                                ": the views do not determine it: more of them are needed, "
                                "tilted more and at other distances");
  const auto n = static_cast<Eigen::Index>(wanted.size());
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(num_columns, n);
  for (Eigen::Index i = 0; i < n; ++i) unit(wanted[i], i) = scale[wanted[i]];
  const Eigen::MatrixXd solved = factors.solve(unit);
  Eigen::MatrixXd covariance(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index k = 0; k < n; ++k) covariance(i, k) = scale[wanted[i]] * solved(wanted[i], k);
  return covariance;
}

}  // namespace visavis
