#include "services/calibrate_tool/least_squares.h"

#include <ceres/crs_matrix.h>
#include <ceres/solver.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <stdexcept>

namespace visavis {
namespace {

/// J^T J of all free parameters; a few hundred, so dense will do.
class NormalEquations {
 public:
  /// @p inputs, free in the problem, are set apart: they come last.
  NormalEquations(ceres::Problem* problem, const std::vector<double*>& inputs) {
    std::vector<double*> all;
    problem->GetParameterBlocks(&all);
    ceres::Problem::EvaluateOptions options;
    int num_columns = 0;
    const auto add = [&](double* block) {
      options.parameter_blocks.push_back(block);
      column_of_[block] = num_columns;
      size_of_[block] = problem->ParameterBlockTangentSize(block);
      num_columns += size_of_[block];
    };
    for (double* block : all) {
      const bool is_input = std::find(inputs.begin(), inputs.end(), block) != inputs.end();
      if (!is_input && !problem->IsParameterBlockConstant(block)) add(block);
    }
    size_ = num_columns;
    for (double* input : inputs) add(input);
    ceres::CRSMatrix J;
    problem->Evaluate(options, nullptr, nullptr, nullptr, &J);
    normal_ = Eigen::MatrixXd::Zero(num_columns, num_columns);
    for (int row = 0; row < J.num_rows; ++row) {
      for (int a = J.rows[row]; a < J.rows[row + 1]; ++a)
        for (int b = J.rows[row]; b < J.rows[row + 1]; ++b)
          normal_(J.cols[a], J.cols[b]) += J.values[a] * J.values[b];
    }
  }

  int size() const { return size_; }
  /// Free parameters by inputs.
  Eigen::MatrixXd mixed() const { return normal_.topRightCorner(size_, normal_.cols() - size_); }

  std::vector<int> Columns(const std::vector<const double*>& blocks) const {
    std::vector<int> columns;
    for (const double* block : blocks)
      for (int i = 0; i < size_of_.at(block); ++i) columns.push_back(column_of_.at(block) + i);
    return columns;
  }

  /// Of the free parameters alone. Scaled to a unit diagonal, so that its pivots tell what the data
  /// determines.
  Eigen::MatrixXd Solve(const std::string& what, const Eigen::MatrixXd& right) const {
    const Eigen::MatrixXd free = normal_.topLeftCorner(size_, size_);
    const Eigen::VectorXd scale = free.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const auto factors = Eigen::MatrixXd(scale.asDiagonal() * free * scale.asDiagonal()).ldlt();
    const Eigen::VectorXd pivots = factors.vectorD();
    if (factors.info() != Eigen::Success || !(pivots.minCoeff() > 1e-13 * pivots.maxCoeff())) {
      throw std::invalid_argument(what +
                                  ": the views do not determine it: more of them are "
                                  "needed, tilted more and at other distances");
    }
    return scale.asDiagonal() * factors.solve(Eigen::MatrixXd(scale.asDiagonal() * right));
  }

 private:
  std::map<const double*, int> column_of_, size_of_;
  int size_{0};
  Eigen::MatrixXd normal_;
};

Eigen::MatrixXd Rows(const Eigen::MatrixXd& matrix, const std::vector<int>& rows) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(rows.size()), matrix.cols());
  for (std::size_t i = 0; i < rows.size(); ++i)
    result.row(static_cast<Eigen::Index>(i)) = matrix.row(rows[i]);
  return result;
}

}  // namespace

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
  const NormalEquations normal(problem, {});
  const std::vector<int> wanted = normal.Columns(blocks);
  Eigen::MatrixXd unit =
      Eigen::MatrixXd::Zero(normal.size(), static_cast<Eigen::Index>(wanted.size()));
  for (std::size_t i = 0; i < wanted.size(); ++i) unit(wanted[i], static_cast<Eigen::Index>(i)) = 1;
  return Rows(normal.Solve(what, unit), wanted);
}

// At the solution J_x^T r = 0; to first order that stays so where H_xx dx + H_xk dk = 0.
Eigen::MatrixXd SensitivityOf(const std::string& what, const std::vector<const double*>& blocks,
                              const std::vector<double*>& inputs, ceres::Problem* problem) {
  for (double* input : inputs) problem->SetParameterBlockVariable(input);
  const NormalEquations normal(problem, inputs);
  for (double* input : inputs) problem->SetParameterBlockConstant(input);
  return -Rows(normal.Solve(what, normal.mixed()), normal.Columns(blocks));
}

}  // namespace visavis
