#include <cmath>

#include "services/simulator/bake.h"
#include "services/simulator/figure.h"
#include "services/simulator/head_grid.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr double kMetrePerMm = 1e-3;

/// Mean place [m] of the texels labelled eye on one side of the face, weighted by the area that
/// they show to the front.
Vector3d EyeCentre(const Texture& texture, const HeadGrid& grid, const SkinSurface& surface,
                   double side) {
  Vector3d sum = Vector3d::Zero();
  double total = 0;
  const double du = 1.0 / texture.width(), dv = 1.0 / texture.height();
  for (int j = 0; j < texture.height(); ++j) {
    for (int i = 0; i < texture.width(); ++i) {
      if (texture.at(i, j).label != Label::kEye) continue;
      const double u = (i + 0.5) * du, v = (j + 0.5) * dv;
      const Vector3d p = surface.ToM(grid.Outer(u, v));
      if (p.x() * side < 0) continue;
      const Vector3d tu = surface.ToM(grid.Outer(u + du, v)) - p;
      const Vector3d tv = surface.ToM(grid.Outer(u, v + dv)) - p;
      const double area = std::abs(tu.cross(tv).z());
      sum += area * p;
      total += area;
    }
  }
  return kMetrePerMm * sum / total;
}

}  // namespace

Part BuildHeadPart(const Subject& subject, const SkinSurface& surface, const FigureDetail& detail,
                   Figure* landmarks) {
  const HeadGrid grid = BuildHeadGrid(subject, surface, detail.head_columns, detail.head_rows);
  Mesh mesh = MakeGrid(grid.columns, grid.rows);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    const Vector3d p_M = surface.ToM(grid.outer[k]);
    mesh.vertices[k] = (kMetrePerMm * p_M).cast<float>();
    mesh.head_weight.push_back(static_cast<float>(1 - SmoothStep(128, 212, grid.outer[k].y())));
  }
  ComputeNormals(&mesh);
  const PaintedSurface painted{[&](double u, double v) { return grid.Outer(u, v); },
                               [&](double u, double v) {
                                 const Vector3d p = grid.Skin(u, v);
                                 Paint paint = PaintSkin(subject, p);
                                 PaintFeatures(subject, p, &paint);
                                 PaintHair(subject, p, u, v, &paint);
                                 return paint;
                               }};
  Texture texture = BakeTexture(painted, detail.texture_size, detail.texture_size);
  if (landmarks != nullptr) {
    landmarks->p_M_eye_right_m = EyeCentre(texture, grid, surface, 1);
    landmarks->p_M_eye_left_m = EyeCentre(texture, grid, surface, -1);
  }
  return {"head", std::move(mesh), std::move(texture)};
}

}  // namespace visavis
