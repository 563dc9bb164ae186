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
  /// The same, sooner where it is near triangle number *@p triangle, which is set to that found.
  Place LocateNear(const Eigen::Vector3f& direction, std::size_t* triangle) const;

 private:
  /// The planes through the origin and a triangle's sides: the volumes that a direction spans with
  /// two corners each, all >= 0 where it leads through the triangle.
  struct Planes {
    Eigen::Matrix3f normals;  ///< rows: opposite to corner 0, 1, 2
    Eigen::Vector3f Shares(const Eigen::Vector3f& direction) const {
      return {normals.row(0).dot(direction), normals.row(1).dot(direction),
              normals.row(2).dot(direction)};
    }
  };

  void Subdivide();
  std::vector<Planes> PlanesOf(const std::vector<Triangle>& triangles) const;
  /// The smallest triangle round @p unit_direction within triangle @p at of @p level.
  std::size_t Descend(std::size_t level, std::size_t at,
                      const Eigen::Vector3f& unit_direction) const;
  Place PlaceIn(std::size_t triangle, const Eigen::Vector3f& unit_direction) const;
  std::size_t Deepest(const std::vector<Planes>& planes, std::size_t begin, std::size_t end,
                      const Eigen::Vector3f& direction) const;
  const Eigen::Vector3f& vertex(std::int32_t i) const {
    return vertices_[static_cast<std::size_t>(i)];
  }

  std::vector<Eigen::Vector3f> vertices_;
  /// By level; the children of triangle t are 4 t to 4 t + 3 of the next.
  std::vector<std::vector<Triangle>> triangles_;
  std::vector<std::vector<Planes>> planes_;  ///< of triangles_
};

}  // namespace visavis
