#pragma once

#include <functional>

#include "services/simulator/mesh.h"
#include "services/simulator/paint.h"
#include "services/simulator/texture.h"

namespace visavis {

/// A surface given by functions of its texture coordinates u, v in [0, 1].
struct PaintedSurface {
  std::function<Eigen::Vector3d(double u, double v)> position_mm;
  std::function<Paint(double u, double v)> paint;
};

/// Paints a texture: colour, gloss and label texel by texel, the fine relief as change of the
/// outward normal. The surface is seen from outside with u to the right and v down.
Texture BakeTexture(const PaintedSurface& surface, int width, int height);

/// A texture of four texels, all alike: for meshes without one.
Texture UniformTexture(const Srgb& colour, double gloss, Label label);

/// Colour, gloss and label of a paint; no change of the normal.
Texel EncodeTexel(const Paint& paint);

}  // namespace visavis
