#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

Eigen::Vector3d AdultEyes() {
  const HeadSurface& adult = TheAdult().surface;
  const HeadShape& shape = adult.shape();
  float inside = 0, outside = 0.2f;
  for (int k = 0; k < 22; ++k) {
    const float depth = 0.5f * (inside + outside);
    const Eigen::Vector3f p(shape.eye_x, shape.eye_y, -depth);
    (p.norm() < adult.Radius(p.normalized()) ? inside : outside) = depth;
  }
  return {0, static_cast<double>(shape.eye_y), -static_cast<double>(inside)};
}

Eigen::Vector3d AdultOrigin() { return {0, -0.0085, 0.015}; }

HeadTable TableOf(const HeadSurface& surface, int level) {
  HeadTable table;
  const Icosphere sphere(level);
  for (const Eigen::Vector3f& direction : sphere.vertices()) {
    const float radius = surface.Radius(direction);
    table.radii_m.push_back(radius);
    table.hair_side_m.push_back(surface.HairSide(radius * direction));
  }
  return table;
}

}  // namespace visavis
