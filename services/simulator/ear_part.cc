#include <cmath>

#include "services/simulator/bake.h"
#include "services/simulator/figure.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr double kPi = M_PI;

/// The auricle in its own plane: a backward, b down from its centre, h outward, for a standard
/// ear of half length 1 (breadth 0.57). @p angle from the front over the top; @p radius 0 at the
/// concha's middle to 1 at the rim.
Vector3d Auricle(double angle, double radius) {
  const double top = std::sin(angle), back = -std::cos(angle);
  // Outline: full above and behind, drawn in to the lobe, straight in front.
  double half_breadth =
      0.50 + 0.10 * SmoothStep(-0.3, 0.7, top) - 0.12 * SmoothStep(-0.5, -1.0, top);
  if (back < 0) half_breadth *= 0.82;
  const double a = radius * half_breadth * std::copysign(std::pow(std::abs(back), 0.75), back),
               b = -radius * (top > 0 ? 0.98 : 1.02) * top;
  const auto ridge = [radius](double at, double width) {
    return std::exp(-std::pow((radius - at) / width, 2));
  };
  const double helix = SmoothStep(-0.75, -0.2, top) * SmoothStep(-1.0, -0.55, back + 0.25 * top);
  double h = 0.20 * ridge(0.93, 0.09) * helix;
  h += 0.17 * ridge(0.60, 0.12) * SmoothStep(-0.35, 0.25, back) * SmoothStep(-0.95, -0.5, top);
  h -= 0.26 * std::exp(-std::pow(radius / 0.36, 2));
  h -= 0.05 * ridge(0.78, 0.07) * helix;
  h += 0.14 * std::exp(-std::pow((radius - 0.42) / 0.12, 2)) *
       SmoothStep(0.75, 0.95, -back);  // tragus
  return {a, b, h};
}

}  // namespace

Part BuildEarPart(const Subject& subject, const SkinSurface& surface, bool image_right) {
  const double side = image_right ? 1 : -1;
  const double half = subject.shape.ear_length_mm / 2;
  const double flare = subject.shape.ear_flare_deg * kPi / 180;
  // Where the front of the ear meets the skin.
  const Vector3d root = surface.Outermost({0, 40, 4}, {1, 0, 0});
  const Vector3d back(std::sin(flare), 0, std::cos(flare)), down(0.06, 0.975, -0.21);
  const Vector3d out(std::cos(flare), 0.0, -std::sin(flare));
  const auto position = [&](double u, double v) {
    // Front from the middle to the rim, then the back from the rim inward.
    const bool front = v <= 0.6;
    const double radius = front ? v / 0.6 : 1 - 0.75 * (v - 0.6) / 0.4;
    Vector3d ear = Auricle(2 * kPi * u, radius);
    if (!front) ear.z() = ear.z() * 0.4 - 0.13 * std::sqrt(std::max(0.0, 1 - radius)) - 0.02;
    ear.z() -= 0.30 * SmoothStep(0.40, 1.05, ear.y());  // the lobe hangs close to the head
    const Vector3d p =
        root + half * ((ear.x() + 0.36) * back + ear.y() * down + (ear.z() + 0.02) * out);
    const Vector3d p_M = surface.ToM(p);
    return Vector3d(side * p_M.x(), p_M.y(), p_M.z());
  };
  Mesh mesh = MakeGrid(32, 20);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const double u = mesh.uv[k].x() == 1 ? 0 : static_cast<double>(mesh.uv[k].x());
    mesh.vertices[k] = (1e-3 * position(u, static_cast<double>(mesh.uv[k].y()))).cast<float>();
  }
  if (image_right) {
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  ComputeNormals(&mesh);
  const Complexion& c = subject.complexion;
  const auto paint = [&](double u, double v) {
    const Vector3d p = position(u, v);
    Paint result;
    result.label = Label::kEar;
    const double blood = 0.10 * c.redness * (c.skin.mean() / 0.65);
    result.colour = c.skin.cwiseProduct(Srgb(1, 1 - blood, 1 - blood));
    const double concha = v < 0.6 ? SmoothStep(0.45, 0.05, v / 0.6) : 0;
    result.colour =
        result.colour.cwiseProduct(Srgb(1 - 0.35 * concha, 1 - 0.5 * concha, 1 - 0.5 * concha));
    result.colour *= 1 + 0.04 * FractalNoise(0.2 * p, 2, subject.seed + 51);
    result.gloss = 0.06;
    return result;
  };
  return {image_right ? "ear_image_right" : "ear_image_left", std::move(mesh),
          BakeTexture({position, paint}, 128, 128)};
}

}  // namespace visavis
