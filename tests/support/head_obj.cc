#include "tests/support/head_obj.h"

#include <cmath>
#include <fstream>
#include <set>

#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/icosphere.h"

namespace visavis {

using Eigen::Vector3f;

std::string AdultMaterial(const Vector3f& p) {
  const HeadShape& s = TheAdult().surface.shape();
  const float x = std::abs(p.x());
  if (TheAdult().surface.HairSide(p) > 0) return "black_hair";
  if (p.z() > -0.03f) return "skin";
  if (std::hypot(x - s.eye_x, p.y() - s.eye_y) < 0.007f) return "eye_white";
  if (std::abs(x - 0.033f) < 0.018f && std::abs(p.y() - s.brow_y) < 0.004f) return "brow";
  if (x < 0.024f && std::abs(p.y() - s.mouth_y) < 0.006f) return "lips";
  return "skin";
}

std::string WriteHeadObj(const std::string& folder, const HeadSurface& surface,
                         const HeadObj& how) {
  const Icosphere sphere(how.level);
  std::ofstream obj(folder + "/head.obj");
  obj << "mtllib head.mtl\n";
  const float up = how.y_up ? -1.0f : 1.0f;
  std::vector<Vector3f> vertices;
  for (const Vector3f& d : sphere.vertices()) {
    Vector3f p = surface.Radius(d) * d;
    vertices.push_back(p);
    if (how.place) p = how.place(p);
    p = static_cast<float>(how.units_per_m) * (p + how.shift_m.cast<float>());
    obj << "v " << p.x() << " " << up * p.y() << " " << up * p.z() << "\n";
  }
  std::set<std::string> materials;
  std::size_t t = static_cast<std::size_t>(how.leave_out);
  for (; t < sphere.triangles().size(); ++t) {
    const auto& [a, b, c] = sphere.triangles()[t];
    const auto at = [&](int i) { return vertices[static_cast<std::size_t>(i)]; };
    const Vector3f middle = (at(a) + at(b) + at(c)) / 3;
    const std::string material = how.material ? how.material(middle) : AdultMaterial(middle);
    materials.insert(material);
    obj << "usemtl " << material << "\nf " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  }
  std::ofstream mtl(folder + "/head.mtl");
  for (const std::string& material : materials)
    mtl << "newmtl " << material << "\nKd 0.5 0.5 0.5\n";
  return folder + "/head.obj";
}

}  // namespace visavis
