#include "services/recogniser/refined/shape_equations.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "common/core/check.h"

namespace visavis {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

}  // namespace

ShapeEquations::ShapeEquations(int level) : sphere_(level), neighbours_(sphere_.vertices().size()) {
  for (const Icosphere::Triangle& triangle : sphere_.triangles()) {
    for (std::size_t i = 0; i < 3; ++i) {  // each edge once: the other triangle runs it backwards
      neighbours_[static_cast<std::size_t>(triangle[i])].push_back(triangle[(i + 1) % 3]);
    }
  }
  Clear();
}

void ShapeEquations::Clear() {
  own_.assign(neighbours_.size(), 0.0);
  with_neighbour_.resize(neighbours_.size());
  for (std::size_t v = 0; v < neighbours_.size(); ++v)
    with_neighbour_[v].assign(neighbours_[v].size(), 0.0);
  g_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(neighbours_.size()));
}

void ShapeEquations::Add(const Eigen::Vector3f& direction, double slope, double residual,
                         double weight) {
  const Icosphere::Place place = sphere_.Locate(direction);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto v = static_cast<std::size_t>(place.corners[i]);
    const double wi = weight * slope * static_cast<double>(place.weights[i]);
    g_[place.corners[i]] += wi * residual;
    own_[v] += wi * slope * static_cast<double>(place.weights[i]);
    for (std::size_t k = 0; k < neighbours_[v].size(); ++k) {
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
        if (neighbours_[v][k] == place.corners[j])
          with_neighbour_[v][k] += wi * slope * static_cast<double>(place.weights[j]);
      }
    }
  }
}

std::vector<float> ShapeEquations::Solve(const std::vector<float>& displaced,
                                         const Prior& prior) const {
  const auto n = static_cast<Eigen::Index>(neighbours_.size());
  VISAVIS_THROW_UNLESS(displaced.size() == neighbours_.size(), displaced.size());
  std::vector<Eigen::Triplet<double>> laplacian, entries;
  for (std::size_t v = 0; v < neighbours_.size(); ++v) {
    const int row = static_cast<int>(v);
    laplacian.emplace_back(row, row, 1.0);
    entries.emplace_back(row, row, own_[v]);
    const double share = 1.0 / static_cast<double>(neighbours_[v].size());
    for (std::size_t k = 0; k < neighbours_[v].size(); ++k) {
      laplacian.emplace_back(row, neighbours_[v][k], -share);
      entries.emplace_back(row, neighbours_[v][k], with_neighbour_[v][k]);
    }
  }
  SparseMatrix L(n, n), data(n, n);
  L.setFromTriplets(laplacian.begin(), laplacian.end());
  data.setFromTriplets(entries.begin(), entries.end());
  const Eigen::VectorXd rough = prior.roughness_m.cwiseAbs2().cwiseInverse();
  const SparseMatrix bending = L.transpose() * rough.asDiagonal() * L;
  SparseMatrix P = bending;
  P.diagonal() += prior.displacement_m.cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd before =
      Eigen::Map<const Eigen::VectorXf>(displaced.data(), n).cast<double>();
  // What is displaced, d, differs from the modes' share U c by what P weighs; c by 1.
  const Eigen::SimplicialLDLT<SparseMatrix> solver(data + P);
  Eigen::VectorXd d = solver.solve(g_ + data * before);
  const Eigen::MatrixXd& U = prior.modes_m;
  if (U.cols() > 0) {
    const Eigen::MatrixXd PU = P * U, Y = solver.solve(PU);
    Eigen::MatrixXd C = U.transpose() * PU - PU.transpose() * Y;
    C.diagonal().array() += 1;
    const Eigen::VectorXd c = C.ldlt().solve(PU.transpose() * d);
    d += Y * c;
  }
  std::vector<float> result(neighbours_.size());
  for (Eigen::Index i = 0; i < n; ++i)
    result[static_cast<std::size_t>(i)] = static_cast<float>(d[i] - before[i]);
  return result;
}

ShapeEquations::Prior ShapeEquations::UniformPrior(double displacement_m,
                                                   double roughness_m) const {
  const auto n = static_cast<Eigen::Index>(neighbours_.size());
  return {Eigen::VectorXd::Constant(n, displacement_m), Eigen::VectorXd::Constant(n, roughness_m),
          Eigen::MatrixXd(n, 0)};
}

}  // namespace visavis
