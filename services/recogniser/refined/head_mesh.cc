#include "services/recogniser/refined/head_mesh.h"

#include <cmath>
#include <map>
#include <utility>

namespace visavis {
namespace {

using Eigen::Vector3f;

/// Unit vertices and triangles (outward, counter-clockwise seen from outside) of an icosahedron.
void Icosahedron(HeadMesh* mesh) {
  const float t = 0.5f * (1 + std::sqrt(5.0f));
  mesh->vertices = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
                    {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  for (Vector3f& v : mesh->vertices) v.normalize();
  mesh->triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
}

/// Each triangle into four.
void Subdivide(HeadMesh* mesh) {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [it, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                  static_cast<int>(mesh->vertices.size()));
    if (is_new) {
      const Vector3f sum =
          mesh->vertices[static_cast<std::size_t>(a)] + mesh->vertices[static_cast<std::size_t>(b)];
      mesh->vertices.push_back(sum.normalized());
    }
    return it->second;
  };
  std::vector<std::array<std::int32_t, 3>> finer;
  finer.reserve(4 * mesh->triangles.size());
  for (const auto& [a, b, c] : mesh->triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.push_back({a, ab, ca});
    finer.push_back({b, bc, ab});
    finer.push_back({c, ca, bc});
    finer.push_back({ab, bc, ca});
  }
  mesh->triangles = std::move(finer);
}

bool IsFeature(const HeadShape& s, const Vector3f& p) {
  if (p.z() > -0.045f) return false;
  const float x = std::abs(p.x()), y = p.y();
  const bool eyes_and_brows =
      x > 0.011f && x < 0.055f && y > s.brow_y - 0.0065f && y < s.eye_y + 0.008f;
  const bool mouth = x < 0.030f && std::abs(y - s.mouth_y) < 0.009f;
  const bool nostrils = x < 0.014f && std::abs(y - s.nostril_y) < 0.007f;
  return eyes_and_brows || mouth || nostrils;
}

float ContourWeight(const Vector3f& p, HeadPart part) {
  const bool below_jaw = p.y() > 0.071f;
  const bool nape = p.y() > 0.043f && p.z() > 0.020f;
  const bool ear = p.y() > -0.021f && p.y() < 0.047f && p.z() > -0.023f && p.z() < 0.037f;
  const bool long_hair = part == HeadPart::kHair && p.y() > 0.023f;
  return below_jaw || nape || ear || long_hair ? 0.0f : 1.0f;
}

void AddNormals(HeadMesh* mesh) {
  mesh->normals.assign(mesh->vertices.size(), Vector3f::Zero());
  for (const auto& triangle : mesh->triangles) {
    const auto at = [&](int i) { return mesh->vertices[static_cast<std::size_t>(triangle[i])]; };
    const Vector3f n = (at(1) - at(0)).cross(at(2) - at(0));
    for (const int i : triangle) mesh->normals[static_cast<std::size_t>(i)] += n;
  }
  for (Vector3f& n : mesh->normals) n.normalize();
}

}  // namespace

HeadMesh MeshOf(const HeadSurface& surface, int level) {
  HeadMesh mesh;
  Icosahedron(&mesh);
  for (int i = 0; i < level; ++i) Subdivide(&mesh);
  for (Vector3f& v : mesh.vertices) v *= surface.Radius(v);
  AddNormals(&mesh);
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      if (a < b) mesh.edges.push_back({a, b});
    }
  }
  for (const Vector3f& p : mesh.vertices) {
    HeadPart part = surface.HairSide(p) > 0 ? HeadPart::kHair : HeadPart::kSkin;
    mesh.contour_weights.push_back(ContourWeight(p, part));
    if (part == HeadPart::kSkin && IsFeature(surface.shape(), p)) part = HeadPart::kFeature;
    mesh.parts.push_back(part);
    const bool chin = p.y() > 0.098f || (p.y() > 0.043f && p.z() > -0.005f);
    const bool near_hairline = std::abs(surface.HairSide(p)) < 0.006f;
    mesh.coloured.push_back(part != HeadPart::kFeature && !chin && !near_hairline);
  }
  return mesh;
}

Hairline HairlineOf(const HeadSurface& surface, int count) {
  Hairline line;
  for (int i = 0; i < count; ++i) {
    const float azimuth =
        static_cast<float>(M_PI / 180) *
        (-80 + 160 * static_cast<float>(i) / static_cast<float>(std::max(count - 1, 1)));
    // Up from the face along the meridian until the plane is crossed.
    float low = -1.4f, high = 1.4f;
    Vector3f p;
    for (int k = 0; k < 22; ++k) {
      const float middle = 0.5f * (low + high);
      const Vector3f d(std::cos(middle) * std::sin(azimuth), -std::sin(middle),
                       -std::cos(middle) * std::cos(azimuth));
      p = surface.Radius(d) * d;
      (surface.HairSide(p) > 0 ? high : low) = middle;
    }
    const Vector3f n = surface.NormalAt(p);
    const Vector3f& h = surface.hair_normal();
    line.points.push_back(p);
    line.into_hair.push_back((h - n * n.dot(h)).normalized());
  }
  return line;
}

}  // namespace visavis
