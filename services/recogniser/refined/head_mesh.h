#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "services/recogniser/refined/head_surface.h"

namespace visavis {

/// What a vertex shows.
enum class HeadPart : std::uint8_t { kSkin, kHair, kFeature };

/// A closed labelled triangle mesh in the M frame [m], and what the estimator needs of it.
struct HeadMesh {
  std::vector<Eigen::Vector3f> vertices, normals;  ///< normals: unit, outward
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::array<std::int32_t, 2>> edges;  ///< each once
  std::vector<HeadPart> parts;
  /// How far a silhouette there counts: 0 at ears, nape and below the jaw, where the outline is the
  /// neck's or not a head's own.
  std::vector<float> contour_weights;
  /// Whether the vertex' colour counts: not below the chin, not at the features.
  std::vector<std::uint8_t> coloured;
};

/// @p surface as an icosphere of 10 * 4^@p level + 2 vertices.
HeadMesh MeshOf(const HeadSurface& surface, int level);

/// Where skin meets hair in front: points on the surface, and the direction on the surface that
/// leads into the hair. No point where the forehead goes on without hair.
struct Hairline {
  std::vector<Eigen::Vector3f> points, into_hair;
};
Hairline HairlineOf(const HeadSurface& surface, int count);

}  // namespace visavis
