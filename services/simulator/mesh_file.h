#pragma once

#include <string>

#include "common/mesh/labelled_mesh.h"
#include "services/simulator/figure.h"

namespace visavis {

/// Reads a head from OBJ, glTF or whatever assimp reads. Each mesh is labelled by its material's
/// name (LabelFromMaterialName) and takes its diffuse colour; pictures are not read. Clothes do not
/// turn with the head. p_M_neck is left as it is by default.
/// @throws std::invalid_argument naming the file and what is wrong: unreadable, no triangles, a
/// material of an unknown kind, a head smaller than 0.1 m or larger than 1 m (a wrong scale).
Figure LoadFigure(const std::string& filename, const MeshFileOptions& options);

}  // namespace visavis
