#pragma once

#include <string>

#include "services/simulator/mesh.h"
#include "services/simulator/texture.h"

namespace visavis {

/// A mesh's surface as a picture shows it.
struct PictureTexture {
  Texture texture;
  /// Opacity by texel of the finest level, row by row, 255 opaque; empty where all is.
  std::vector<std::uint8_t> opacity;
};

/// Reads a picture (PNG, JPEG, ...) as sRGB colours of a surface of one kind, scaled to powers of
/// two, at most @p largest. Colours spread into transparent parts, so that none of what hides there
/// is seen at the cut edges.
/// @throws std::invalid_argument naming the file, where it can't be read.
PictureTexture ReadPictureTexture(const std::string& filename, double gloss, Label label,
                                  int largest);

/// Leaves out what is less than half opaque: triangles at the border are cut into smaller ones
/// until none is larger than @p cell_m, and each of these is there or not.
void CutOut(const PictureTexture& picture, float cell_m, Mesh* mesh);

}  // namespace visavis
