#include "services/simulator/mesh_file.h"

#include <stdexcept>
#include <utility>

#include "services/simulator/bake.h"

namespace visavis {
namespace {

[[noreturn]] void Refuse(const std::string& filename, const std::string& reason) {
  throw std::invalid_argument(filename + ": " + reason);
}

double Gloss(Label label) {
  switch (label) {
    case Label::kEye:
      return 0.5;
    case Label::kHair:
    case Label::kBrow:
    case Label::kLash:
      return 0.15;
    case Label::kClothes:
      return 0.015;
    default:
      return 0.05;
  }
}

Mesh MeshOf(LabelledPart* part) {
  Mesh mesh;
  mesh.uv.assign(part->vertices.size(), Eigen::Vector2f(0.5f, 0.5f));
  mesh.vertices = std::move(part->vertices);
  mesh.triangles = std::move(part->triangles);
  ComputeNormals(&mesh);
  return mesh;
}

}  // namespace

Figure LoadFigure(const std::string& filename, const MeshFileOptions& options) {
  Figure figure;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(1e9f), high = -low;
  for (LabelledPart& from : LoadLabelledMesh(filename, options)) {
    if (IsHead(from.label)) {
      for (const Eigen::Vector3f& vertex : from.vertices) {
        low = low.cwiseMin(vertex);
        high = high.cwiseMax(vertex);
      }
    }
    const Srgb colour = from.diffuse.cwiseMax(0).cwiseMin(1).unaryExpr(&SrgbFromLinear);
    auto& parts = from.label == Label::kClothes ? figure.body : figure.head;
    parts.push_back(
        {from.name, MeshOf(&from), UniformTexture(colour, Gloss(from.label), from.label)});
    try {
      parts.back().mesh.ValidateOrThrow();
    } catch (const std::invalid_argument& e) {
      Refuse(filename, "mesh '" + from.name + "': " + e.what());
    }
  }
  if (figure.head.empty()) Refuse(filename, "holds no triangles of a head");
  const float height = (high - low).maxCoeff();
  if (!(height >= 0.1f && height <= 1.0f)) {
    Refuse(filename, "head is " + std::to_string(height) +
                         " m large: must be 0.1 to 1 m; is the scale right?");
  }
  return figure;
}

}  // namespace visavis
