#include "services/simulator/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "services/simulator/bake.h"
#include "services/simulator/picture_texture.h"

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

constexpr int kLargestPicture = 2048;
constexpr float kCutOutCell_m = 0.0015f;  ///< finer than a pixel at 1 m
constexpr float kNeck_m = 0.084f;         ///< from the chin down to where it follows the body

Mesh MeshOf(LabelledPart* part) {
  Mesh mesh;
  if (part->uv.empty()) part->uv.assign(part->vertices.size(), Eigen::Vector2f(0.5f, 0.5f));
  mesh.vertices = std::move(part->vertices);
  mesh.triangles = std::move(part->triangles);
  mesh.uv = std::move(part->uv);
  // Pictures repeat: each triangle where its middle lies within the first one.
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector2f middle = (mesh.uv[a] + mesh.uv[b] + mesh.uv[c]) / 3;
    const Eigen::Vector2f shift = middle.array().floor();
    if (shift.isZero()) continue;
    for (const std::uint32_t i : {a, b, c}) mesh.uv[i] -= shift;
  }
  for (Eigen::Vector2f& uv : mesh.uv) uv = uv.cwiseMax(0).cwiseMin(1);
  ComputeNormals(&mesh);
  return mesh;
}

/// The neck bends between the chin and the shoulders.
void BendNecks(Figure* figure) {
  float chin = -1e9f;
  for (const Part& part : figure->head) {
    if (!IsFace(part.texture.at(0, 0).label)) continue;
    for (const Eigen::Vector3f& p : part.mesh.vertices) chin = std::max(chin, p.y());
  }
  for (Part& part : figure->head) {
    if (part.texture.at(0, 0).label != Label::kNeck) continue;
    for (const Eigen::Vector3f& p : part.mesh.vertices) {
      const float t = std::clamp((p.y() - chin) / kNeck_m, 0.0f, 1.0f);
      part.mesh.head_weight.push_back(1 - t * t * (3 - 2 * t));
    }
  }
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
    const bool has_picture = !from.picture.empty() && !from.uv.empty();
    Mesh mesh = MeshOf(&from);
    try {
      mesh.ValidateOrThrow();
    } catch (const std::invalid_argument& e) {
      Refuse(filename, "mesh '" + from.name + "': " + e.what());
    }
    auto& parts = from.label == Label::kClothes ? figure.body : figure.head;
    if (has_picture) {
      PictureTexture picture =
          ReadPictureTexture(from.picture, Gloss(from.label), from.label, kLargestPicture);
      CutOut(picture, kCutOutCell_m, &mesh);
      parts.push_back({from.name, std::move(mesh), std::move(picture.texture)});
    } else {
      const Srgb colour = from.diffuse.cwiseMax(0).cwiseMin(1).unaryExpr(&SrgbFromLinear);
      parts.push_back(
          {from.name, std::move(mesh), UniformTexture(colour, Gloss(from.label), from.label)});
    }
  }
  if (figure.head.empty()) Refuse(filename, "holds no triangles of a head");
  const float height = (high - low).maxCoeff();
  if (!(height >= 0.1f && height <= 1.0f)) {
    Refuse(filename, "head is " + std::to_string(height) +
                         " m large: must be 0.1 to 1 m; is the scale right?");
  }
  BendNecks(&figure);
  return figure;
}

}  // namespace visavis
