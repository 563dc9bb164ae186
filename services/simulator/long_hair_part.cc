#include <algorithm>
#include <cmath>

#include "services/simulator/bake.h"
#include "services/simulator/figure.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

}  // namespace

Part BuildLongHairPart(const Subject& subject, const SkinSurface& surface, int texture_size) {
  // A curtain round the back of the head, open over the face, from above the ears to the
  // shoulders; its front edges are turned in towards the skin. Average coordinates [mm].
  static const Profile half_width{{-62, 56}, {-45, 71}, {-28, 81}, {-5, 87},
                                  {30, 91},  {80, 92},  {120, 88}, {150, 76}};
  static const Profile front{{-62, 70}, {-40, 84}, {0, 92}, {150, 92}};
  static const Profile behind{{-62, 70}, {-45, 90}, {-25, 104}, {10, 110},
                              {60, 106}, {110, 96}, {150, 84}};
  static const Profile opening_deg{{-62, 44}, {-30, 55}, {0, 66}, {40, 76}, {90, 78}, {150, 92}};
  const auto position = [&](double u, double v) {
    // The lower edge is not cut quite straight.
    const double ragged = 1 + 0.035 * Noise({9 * u, 1, 0}, subject.seed + 63) +
                          0.02 * Noise({45 * u, 2, 0}, subject.seed + 64);
    const double y = -62 + 206 * v * ragged;
    // The outer 4 % of the columns on each side are the turned-in edge.
    constexpr double kEdge = 0.04;
    const double inner = std::clamp((u - kEdge) / (1 - 2 * kEdge), 0.0, 1.0);
    const double fold = std::max(std::abs(u - 0.5) - (0.5 - kEdge), 0.0) / kEdge;
    const double open = opening_deg(y) * M_PI / 180;
    // From the image's right edge over the back to the left edge, so that u runs right from
    // outside.
    const double azimuth = open + inner * (2 * M_PI - 2 * open);
    const double s = std::sin(azimuth), c = -std::cos(azimuth);
    const double depth = c < 0 ? front(y) : behind(y);
    const double r = 1 / std::sqrt(std::pow(s / half_width(y), 2) + std::pow(c / depth, 2));
    Vector3d p(r * s, y, 6 + r * c);
    const double wave =
        2.6 * Noise({5.5 * azimuth, 0.012 * y, 0}, subject.seed + 61) * SmoothStep(-62, -20, y) +
        1.5 * Noise({16 * azimuth, 0.02 * y, 4}, subject.seed + 62);
    const Vector3d outward = Vector3d(p.x(), 0, p.z()).normalized();
    p += wave * outward;
    return Vector3d(p - fold * (16 + 8 * SmoothStep(60, 140, y)) * outward);
  };
  Mesh mesh = MakeGrid(88, 44);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const Vector3d p =
        position(static_cast<double>(mesh.uv[k].x()), static_cast<double>(mesh.uv[k].y()));
    mesh.vertices[k] = (1e-3 * surface.ToM(p)).cast<float>();
  }
  ComputeNormals(&mesh);
  const auto paint = [&](double u, double v) {
    Paint strands = PaintStrands(subject, 430 * u, 212 * v);
    strands.colour *= 0.9 + 0.1 * SmoothStep(0.0, 0.3, v);
    return strands;
  };
  return {"long_hair", std::move(mesh),
          BakeTexture({position, paint}, texture_size, texture_size / 2)};
}

}  // namespace visavis
