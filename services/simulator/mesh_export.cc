#include "services/simulator/mesh_export.h"

#include <array>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

namespace visavis {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

const char* MaterialOf(Label label) {
  switch (label) {
    case Label::kHair:
      return "hair";
    case Label::kEye:
      return "eye";
    case Label::kBrow:
      return "brow";
    case Label::kLash:
      return "lash";
    case Label::kLips:
      return "lips";
    case Label::kNostril:
      return "nostril";
    case Label::kEar:
      return "ear";
    case Label::kNeck:
      return "neck";
    default:
      return "skin";
  }
}

/// The label that the texture has in the middle of the triangle.
Label LabelOf(const Part& part, const Triangle& triangle) {
  const auto& uv = part.mesh.uv;
  const Eigen::Vector2f middle = (uv[triangle[0]] + uv[triangle[1]] + uv[triangle[2]]) / 3;
  return Texture::Fetch(part.texture.Locate(middle.x(), middle.y(), 0)).label;
}

/// The grid's last row, closed by a fan round its middle.
std::vector<Triangle> Cap(const Mesh& mesh, std::uint32_t middle) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> edges;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) edges[{from, to}] = true;
  }
  std::vector<Triangle> cap;
  for (const auto& edge : edges) {
    const auto [from, to] = edge.first;
    // Of the borders of the grid the seam is joined and the vertex a point.
    const bool is_border = edges.count({to, from}) == 0;
    const bool is_seam = mesh.uv[from].x() == mesh.uv[to].x();
    const bool is_top = mesh.uv[from].y() == 0 && mesh.uv[to].y() == 0;
    if (is_border && !is_seam && !is_top) cap.push_back({to, from, middle});
  }
  return cap;
}

}  // namespace

void ExportHead(const Figure& figure, const std::string& filename) {
  const Part& head = figure.head.at(0);
  const Mesh& mesh = head.mesh;
  std::map<std::string, std::vector<Triangle>> by_material;
  for (const Triangle& triangle : mesh.triangles) {
    by_material[MaterialOf(LabelOf(head, triangle))].push_back(triangle);
  }
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  const std::vector<Triangle> cap = Cap(mesh, middle);
  Eigen::Vector3f centre = Eigen::Vector3f::Zero();
  for (const Triangle& triangle : cap) centre += mesh.vertices[triangle[0]];
  if (!cap.empty()) centre /= static_cast<float>(cap.size());
  auto& neck = by_material["neck"];
  neck.insert(neck.end(), cap.begin(), cap.end());

  const std::string materials = filename + ".mtl";
  std::ofstream obj(filename), mtl(materials);
  obj.precision(std::numeric_limits<float>::max_digits10);
  obj << "# A simulated head: metres, x right, y up, z to the viewer\nmtllib "
      << materials.substr(materials.find_last_of('/') + 1) << "\n";
  const auto write = [&](const Eigen::Vector3f& p) {
    obj << "v " << p.x() << " " << -p.y() << " " << -p.z() << "\n";
  };
  for (const Eigen::Vector3f& p : mesh.vertices) write(p);
  write(centre);
  for (const auto& [material, triangles] : by_material) {
    mtl << "newmtl " << material << "\nKd 0.5 0.5 0.5\n";
    obj << "usemtl " << material << "\n";
    for (const auto& [a, b, c] : triangles) {
      obj << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
    }
  }
  obj.close();
  mtl.close();
  if (!obj || !mtl) throw std::runtime_error(filename + ": cannot be written");
}

}  // namespace visavis
