#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace visavis {

/// An icosahedron on the unit sphere, each triangle divided into four @p level times: even
/// directions, 10 * 4^level + 2 of them. The order of the vertices is fixed: tables by direction
/// are kept in files.
class Icosphere {
 public:
  using Triangle = std::array<std::int32_t, 3>;
  static constexpr int kMaxLevel = 6;

  /// @throws std::invalid_argument unless 0 <= level <= kMaxLevel.
  explicit Icosphere(int level);
  /// The level of so many vertices; -1: of none.
  static int LevelOf(std::size_t num_vertices);

  int level() const { return static_cast<int>(triangles_.size()) - 1; }
  const std::vector<Eigen::Vector3f>& vertices() const { return vertices_; }
  /// Outward, counter-clockwise seen from outside.
  const std::vector<Triangle>& triangles() const { return triangles_.back(); }

  /// The triangle that @p direction (any length but 0) leads through; the weights are >= 0, of
  /// sum 1, and give the point where it does.
  struct Place {
    Triangle corners;
    Eigen::Vector3f weights;
  };
  Place Locate(const Eigen::Vector3f& direction) const;

 private:
  void Subdivide();
  const Eigen::Vector3f& vertex(std::int32_t i) const {
    return vertices_[static_cast<std::size_t>(i)];
  }

  std::vector<Eigen::Vector3f> vertices_;
  /// By level; the children of triangle t are 4 t to 4 t + 3 of the next.
  std::vector<std::vector<Triangle>> triangles_;
};

}  // namespace visavis
