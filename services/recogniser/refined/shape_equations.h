#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "services/recogniser/refined/icosphere.h"

namespace visavis {

/// Normal equations of a head's shape: unknown is how far the surface moves outward, along the
/// direction from M's origin, at each vertex of an icosphere [m]; linear between the vertices.
class ShapeEquations {
 public:
  /// @p level of the icosphere: 4 has 2562 vertices.
  explicit ShapeEquations(int level);

  const Icosphere& sphere() const { return sphere_; }
  void Clear();
  /// One measurement: the surface in @p direction should move so that slope * movement = residual.
  /// @p weight: inverse variance.
  void Add(const Eigen::Vector3f& direction, double slope, double residual, double weight);

  /// How a shape may differ from the one it starts from: by a mixture of modes, each of standard
  /// deviation 1, and by what these leave, by vertex.
  struct Prior {
    Eigen::VectorXd displacement_m;  ///< standard deviation
    Eigen::VectorXd roughness_m;     ///< of a vertex from the mean of its neighbours
    Eigen::MatrixXd modes_m;         ///< a column a mode; none: 0 columns
  };
  Prior UniformPrior(double displacement_m, double roughness_m) const;
  /// The movement at each vertex, if the surface lies @p displaced (by vertex) from the one that
  /// the prior is about already.
  std::vector<float> Solve(const std::vector<float>& displaced, const Prior& prior) const;

 private:
  const Icosphere sphere_;
  std::vector<std::vector<int>> neighbours_;
  // Of the normal matrix: one entry a vertex, and one for each of its neighbours.
  std::vector<double> own_;
  std::vector<std::vector<double>> with_neighbour_;
  Eigen::VectorXd g_;
};

}  // namespace visavis
