#include <algorithm>
#include <cmath>

#include "services/simulator/bake.h"
#include "services/simulator/figure.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr double kTop = 172, kBottom = 660;  ///< [mm] below the average head's origin

Paint PaintCloth(const Subject& subject, double arc_mm, const Vector3d& p, double below_collar_mm) {
  const Clothes& clothes = subject.clothes;
  Paint paint;
  paint.label = Label::kClothes;
  paint.colour = clothes.colour;
  switch (clothes.pattern) {
    case Clothes::Pattern::kPlain:
      break;
    case Clothes::Pattern::kStripes:
      paint.Blend(clothes.second,
                  SmoothStep(-0.1, 0.1, std::sin(2 * M_PI * below_collar_mm / 38) - 0.25));
      break;
    case Clothes::Pattern::kChecks: {
      const double x = std::sin(2 * M_PI * arc_mm / 46),
                   y = std::sin(2 * M_PI * below_collar_mm / 46);
      paint.Blend(clothes.second,
                  0.40 * SmoothStep(0.4, 0.55, x) + 0.40 * SmoothStep(0.4, 0.55, y));
      break;
    }
    case Clothes::Pattern::kZip:
      paint.Blend(0.25 * Srgb::Ones(),
                  SmoothStep(6, 4.5, std::abs(p.x())) * SmoothStep(60, 0, p.z()));
      paint.Blend(0.75 * Srgb::Ones(),
                  SmoothStep(1.8, 1.0, std::abs(p.x())) * SmoothStep(60, 0, p.z()));
      break;
  }
  // A ribbed collar, folds that run from neck and shoulders, the weave.
  if (below_collar_mm < 20) {
    paint.colour = clothes.colour * (0.80 + 0.06 * std::cos(2 * M_PI * arc_mm / 3.2));
    paint.height_mm = 1.2;
  }
  const double fold =
      FractalNoise({0.012 * p.x(), 0.007 * p.y(), 0.012 * p.z()}, 3, subject.seed + 71);
  const double weave = Noise(0.8 * p, subject.seed + 72);
  paint.height_mm += 7.0 * fold * SmoothStep(10, 60, below_collar_mm) + 0.06 * weave;
  paint.colour *= 1 + 0.05 * weave + 0.04 * fold;
  paint.gloss = 0.015;
  return paint;
}

}  // namespace

Part BuildBodyPart(const Subject& subject, const SkinSurface& surface, int texture_size) {
  const double neck = subject.shape.neck_breadth_mm / 2,
               shoulder = subject.clothes.shoulder_breadth_mm / 2;
  const double lift = subject.clothes.collar_mm;
  const Profile half_width{{0, neck + 4},
                           {12, neck + 13},
                           {24, neck + 38},
                           {38, neck + 80},
                           {50, 0.40 * neck + 0.66 * shoulder},
                           {66, 0.87 * shoulder},
                           {92, 0.95 * shoulder},
                           {145, shoulder},
                           {490, 0.97 * shoulder}};
  const Profile front{{0, 57}, {12, 66}, {40, 84}, {80, 100}, {160, 122}, {490, 128}};
  const Profile behind{{0, 60}, {26, 86}, {60, 102}, {160, 116}, {490, 112}};
  const Profile centre{{0, 34}, {60, 44}, {490, 46}};
  const double origin_y = surface.ToM({0, kTop, 0}).y();
  const auto position = [&](double u, double v) {
    // Rows lie closer near the collar. The collar's front dips.
    const double below = (kBottom - kTop) * std::pow(v, 1.6);
    const double azimuth = 2 * M_PI * (u - 0.5);
    const double s = std::sin(azimuth), c = -std::cos(azimuth);
    const double n = 2.1 + 0.7 * SmoothStep(40, 140, below);
    const double depth = c < 0 ? front(below) : behind(below);
    const double r = std::pow(
        std::pow(std::abs(s) / half_width(below), n) + std::pow(std::abs(c) / depth, n), -1 / n);
    const double dip = (c < 0 ? 22 * c * c : -6 * c * c) * SmoothStep(60, 0, below);
    const double standing = lift * SmoothStep(14, 0, below);
    return Vector3d(r * s, origin_y + below + dip - standing, centre(below) + r * c);
  };
  Mesh mesh = MakeGrid(96, 44);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const double u = mesh.uv[k].x() == 1 ? 0 : static_cast<double>(mesh.uv[k].x());
    mesh.vertices[k] = (1e-3 * position(u, static_cast<double>(mesh.uv[k].y()))).cast<float>();
  }
  ComputeNormals(&mesh);
  const auto paint = [&](double u, double v) {
    return PaintCloth(subject, 1300 * u, position(u, v), (kBottom - kTop) * std::pow(v, 1.6));
  };
  return {"body", std::move(mesh), BakeTexture({position, paint}, texture_size, texture_size)};
}

Figure BuildFigure(const Subject& subject, const FigureDetail& detail) {
  subject.ValidateOrThrow();
  const SkinSurface surface(subject.shape);
  Figure figure;
  figure.head.push_back(BuildHeadPart(subject, surface, detail, &figure));
  for (const bool image_right : {true, false}) {
    figure.head.push_back(BuildEarPart(subject, surface, image_right));
  }
  if (subject.hair.kind == HairStyle::Kind::kLong) {
    figure.head.push_back(BuildLongHairPart(subject, surface, detail.texture_size / 2));
  }
  figure.body.push_back(BuildBodyPart(subject, surface, detail.texture_size / 2));
  return figure;
}

}  // namespace visavis
