#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/mesh/label.h"

namespace visavis {

/// How a mesh file becomes a head in M's axes (x right, y down, z away from the viewer).
struct MeshFileOptions {
  double scale{1};  ///< metres per unit of the file
  bool y_up{true};  ///< the file's axes are x right, y up, z towards the viewer (glTF); false: M's
  Eigen::Vector3d p_origin_m{0, 0, 0};  ///< M's origin, in the scaled file's own axes
};

/// Triangles of one material.
struct LabelledPart {
  std::string name;
  Label label{Label::kBackground};
  Eigen::Vector3d diffuse{0.6, 0.6, 0.6};  ///< the material's colour, linear, as the file has it
  std::string picture;                     ///< file of the material's picture; empty: none
  std::vector<Eigen::Vector3f> vertices;   ///< [m] in M's axes
  /// Where in the picture, by vertex: u along its rows, v down, the picture repeats beyond [0, 1].
  /// Empty where the file has none.
  std::vector<Eigen::Vector2f> uv;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads OBJ, glTF or whatever assimp reads. Each part is labelled by its material's name
/// (LabelFromMaterialName); its picture is named, not read.
/// @throws std::invalid_argument naming the file and what is wrong: unreadable, no triangles, a
/// material of an unknown kind, a corner that is no number.
std::vector<LabelledPart> LoadLabelledMesh(const std::string& filename,
                                           const MeshFileOptions& options);

}  // namespace visavis
