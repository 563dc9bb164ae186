#include "common/geometry/pinhole.h"

#include <cmath>

#include "common/core/check.h"

namespace visavis {
namespace {

Eigen::Vector2d Distort(const std::array<double, 5>& k, const Eigen::Vector2d& p) {
  const double x = p.x(), y = p.y(), r2 = p.squaredNorm();
  const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  return {x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
          y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

}  // namespace

void Pinhole::ValidateOrThrow() const {
  VISAVIS_THROW_UNLESS(width >= 1 && width <= 16384, width);
  VISAVIS_THROW_UNLESS(height >= 1 && height <= 16384, height);
  VISAVIS_THROW_UNLESS(std::isfinite(fx) && fx >= 1, fx);
  VISAVIS_THROW_UNLESS(std::isfinite(fy) && fy >= 1, fy);
  VISAVIS_THROW_UNLESS(cx > -width && cx < 2.0 * width, cx);
  VISAVIS_THROW_UNLESS(cy > -height && cy < 2.0 * height, cy);
  for (const double k : distortion) VISAVIS_THROW_UNLESS(std::isfinite(k), k);
}

Projection Project(const Pinhole& camera, const Eigen::Vector3d& p_C) {
  if (!(p_C.z() > 0)) return {Eigen::Vector2d::Constant(std::nan("")), false};
  Eigen::Vector2d p = p_C.head<2>() / p_C.z();
  if (camera.has_distortion()) p = Distort(camera.distortion, p);
  return {{camera.fx * p.x() + camera.cx, camera.fy * p.y() + camera.cy}, true};
}

Eigen::Vector3d Unproject(const Pinhole& camera, const Eigen::Vector2d& uv) {
  const Eigen::Vector2d distorted((uv.x() - camera.cx) / camera.fx,
                                  (uv.y() - camera.cy) / camera.fy);
  Eigen::Vector2d p = distorted;
  if (camera.has_distortion()) {
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector2d step = distorted - Distort(camera.distortion, p);
      p += step;
      if (step.squaredNorm() < 1e-24) break;
    }
  }
  return {p.x(), p.y(), 1};
}

}  // namespace visavis
