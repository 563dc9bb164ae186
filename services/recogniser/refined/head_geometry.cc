#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

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
