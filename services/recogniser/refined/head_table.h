#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "services/recogniser/refined/icosphere.h"

namespace visavis {

/// A star-shaped head by direction from M's origin: one entry a vertex of Icosphere(level), in its
/// order, for the level of so many vertices (4: 2562). Linear between the vertices.
struct HeadTable {
  std::vector<float> radii_m;
  /// Distance along the surface from the border between hair and skin, positive in the hair. Empty:
  /// the plane C_h of the HeadShape that goes with the table tells.
  std::vector<float> hair_side_m;
  /// Standard deviation of the radii. Empty: they are known.
  std::vector<float> sigma_m;

  /// @throws std::invalid_argument for a number of entries that no level has, and for radii that
  /// are not kMinRadius_m to kMaxRadius_m.
  void ValidateOrThrow() const;

  static constexpr float kMinRadius_m = 0.02f, kMaxRadius_m = 0.4f;
};

/// A table made ready for look-ups.
class TabulatedHead {
 public:
  /// @throws std::invalid_argument as HeadTable::ValidateOrThrow.
  explicit TabulatedHead(HeadTable table);

  const HeadTable& table() const { return table_; }
  const Icosphere& sphere() const { return sphere_; }
  /// [m] in @p direction.
  float Radius(const Eigen::Vector3f& direction) const;
  /// [m] standard deviation of the radius in @p direction.
  float Sigma(const Eigen::Vector3f& direction) const;
  bool has_hair_side() const { return !table_.hair_side_m.empty(); }
  float HairSide(const Eigen::Vector3f& direction) const;
  /// Outward unit normal, smooth.
  Eigen::Vector3f Normal(const Eigen::Vector3f& direction) const;

 private:
  HeadTable table_;
  Icosphere sphere_;
  std::vector<Eigen::Vector3f> normals_;
};

/// Unit normals at the vertices of a closed mesh, outward where the triangles are, weighted by
/// area.
std::vector<Eigen::Vector3f> VertexNormals(const std::vector<Eigen::Vector3f>& vertices,
                                           const std::vector<Icosphere::Triangle>& triangles);

}  // namespace visavis
