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
  entries_.clear();
  g_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(neighbours_.size()));
}

void ShapeEquations::Add(const Eigen::Vector3f& direction, double slope, double residual,
                         double weight) {
  const Icosphere::Place place = sphere_.Locate(direction);
  for (int i = 0; i < 3; ++i) {
    const int row = place.corners[static_cast<std::size_t>(i)];
    const double wi = weight * slope * static_cast<double>(place.weights[i]);
    g_[row] += wi * residual;
    for (int j = 0; j < 3; ++j) {
      entries_.emplace_back(row, place.corners[static_cast<std::size_t>(j)],
                            wi * slope * static_cast<double>(place.weights[j]));
    }
  }
}

std::vector<float> ShapeEquations::Solve(const std::vector<float>& displaced,
                                         const Prior& prior) const {
  const auto n = static_cast<Eigen::Index>(neighbours_.size());
  VISAVIS_THROW_UNLESS(displaced.size() == neighbours_.size(), displaced.size());
  std::vector<Eigen::Triplet<double>> laplacian;
  for (std::size_t v = 0; v < neighbours_.size(); ++v) {
    const int row = static_cast<int>(v);
    laplacian.emplace_back(row, row, 1.0);
    const double share = 1.0 / static_cast<double>(neighbours_[v].size());
    for (const int w : neighbours_[v]) laplacian.emplace_back(row, w, -share);
  }
  SparseMatrix L(n, n), data(n, n), identity(n, n);
  L.setFromTriplets(laplacian.begin(), laplacian.end());
  data.setFromTriplets(entries_.begin(), entries_.end());
  identity.setIdentity();
  const SparseMatrix rough = L.transpose() * L;
  const SparseMatrix P = rough / (prior.roughness_m * prior.roughness_m) +
                         identity / (prior.displacement_m * prior.displacement_m);
  const Eigen::VectorXd before =
      Eigen::Map<const Eigen::VectorXf>(displaced.data(), n).cast<double>();
  const Eigen::SimplicialLDLT<SparseMatrix> solver(data + P);
  const Eigen::VectorXd movement = solver.solve(g_ - P * before);
  std::vector<float> result(neighbours_.size());
  std::transform(movement.begin(), movement.end(), result.begin(),
                 [](double m) { return static_cast<float>(m); });
  return result;
}

}  // namespace visavis
