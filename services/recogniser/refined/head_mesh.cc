#include "services/recogniser/refined/head_mesh.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kOnHairline_m = 0.001f;
constexpr float kOutline_m = 0.004f;    ///< what an outline may be off by where the head is known
constexpr float kHairDoubt_m = 0.012f;  ///< at least: hair may be done in any way

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

/// Of the outline there: 1 on a head that is known.
float Certainty(const HeadSurface& surface, const Vector3f& p, HeadPart part) {
  float sigma = surface.Sigma(p);
  if (part == HeadPart::kHair && sigma > 0) sigma = std::max(sigma, kHairDoubt_m);
  return kOutline_m / std::hypot(kOutline_m, sigma);
}

}  // namespace

HeadMesh MeshOf(const HeadSurface& surface, int level) {
  HeadMesh mesh;
  const Icosphere sphere(level);
  mesh.vertices = sphere.vertices();
  mesh.triangles = sphere.triangles();
  for (Vector3f& v : mesh.vertices) v *= surface.Radius(v);
  mesh.normals = VertexNormals(mesh.vertices, mesh.triangles);
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangle[i], b = triangle[(i + 1) % 3];
      if (a < b) mesh.edges.push_back({a, b});
    }
  }
  for (const Vector3f& p : mesh.vertices) {
    HeadPart part = surface.HairSide(p) > 0 ? HeadPart::kHair : HeadPart::kSkin;
    mesh.contour_weights.push_back(ContourWeight(p, part) * Certainty(surface, p, part));
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
    if (std::abs(surface.HairSide(p)) > kOnHairline_m) continue;  // bald there
    line.points.push_back(p);
    line.into_hair.push_back(surface.IntoHair(p));
  }
  return line;
}

}  // namespace visavis
