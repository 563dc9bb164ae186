#pragma once

#include <string>

#include "common/mesh/labelled_mesh.h"
#include "services/simulator/figure.h"

namespace visavis {

/// Reads a head from OBJ, glTF or whatever assimp reads. Each mesh is labelled by its material's
/// name (LabelFromMaterialName) and takes its picture, cut out where that is transparent, or its
/// diffuse colour. Clothes do not turn with the head; what is labelled neck bends from the chin
/// down. p_M_neck is left as it is by default.
/// @throws std::invalid_argument naming the file and what is wrong: unreadable, no triangles, a
/// material of an unknown kind, a picture that can't be read, a head smaller than 0.1 m or larger
/// than 1 m (a wrong scale).
Figure LoadFigure(const std::string& filename, const MeshFileOptions& options);

}  // namespace visavis
