#pragma once

#include <vector>

#include "common/mesh/labelled_mesh.h"
#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

/// The head that a closed, labelled mesh in M's axes [m] shows, as radii by direction. Its eyes go
/// where the generic adult's are; brows, nostrils and mouth are where the mesh has them, else where
/// an adult has them. Ears and neck count only where nothing else is; a beard counts as skin.
/// p_MR is zero: poses are reported as those of the generic adult.
/// @param p_M_of_mesh  if not null, set to M's origin in the mesh's frame.
/// @throws std::invalid_argument with what is found and the rule: an edge without two triangles; a
/// head that is not 0.12 to 0.45 m high, has no eyes, its eyes not 40 to 90 mm apart, behind its
/// middle or below its mouth; one that its middle lies outside of or that is not star-shaped about
/// it.
HeadGeometry HeadFromMesh(const std::vector<LabelledPart>& parts,
                          Eigen::Vector3d* p_M_of_mesh = nullptr);

}  // namespace visavis
