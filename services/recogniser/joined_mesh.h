#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/labelled_mesh.h"

namespace visavis {

/// A head's surface in one piece: corners at the same place (to 2 um) joined, each triangle with
/// its label. Clothes are left out.
struct JoinedMesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<Label> labels;  ///< of each triangle
};

/// @throws std::invalid_argument where an edge has not two triangles.
JoinedMesh JoinParts(const std::vector<LabelledPart>& parts);

}  // namespace visavis
