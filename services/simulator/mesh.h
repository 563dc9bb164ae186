#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace visavis {

/// A triangle mesh with texture coordinates. Vectors of vertex data have one entry a vertex.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< [m]
  std::vector<Eigen::Vector3f> normals;   ///< unit, outward
  std::vector<Eigen::Vector2f> uv;        ///< in [0, 1]: u along a texture's row, v down
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  /// Share with which a vertex follows the head (1) or the body (0); empty: all follow the head.
  std::vector<float> head_weight;

  /// @throws std::invalid_argument when sizes disagree, an index is out of range or a coordinate is
  /// not finite.
  void ValidateOrThrow() const;
};

/// Sets the normals from the triangles, weighted by area. Vertices at the same place (a seam of
/// the texture) share theirs.
void ComputeNormals(Mesh* mesh);

/// A grid of (columns + 1) x (rows + 1) vertices, vertex (i, j) at index j * (columns + 1) + i with
/// uv = (i / columns, j / rows); triangles face the side from which u runs right and v down.
/// Vertices and normals are left for the caller to fill.
Mesh MakeGrid(int columns, int rows);

/// A sphere of @p radius_m about the origin.
Mesh MakeSphere(double radius_m, int columns, int rows);

}  // namespace visavis
