#include "tests/support/painted_head.h"

#include <cmath>

namespace visavis {
namespace {

struct Rgb {
  std::uint8_t r, g, b;
};

constexpr Rgb kWall{200, 205, 210}, kHair{20, 18, 16}, kSkin{224, 172, 140}, kFeature{40, 35, 38};

Rgb ColorAt(const HeadModelConfig& c, const HeadModel& model, const Eigen::Vector3d& p_M) {
  if (model.hair_normal().dot(p_M) > model.hair_offset_m()) return kHair;
  if (p_M.z() > 0) return kSkin;
  const double x = 1e3 * std::abs(p_M.x()), y = 1e3 * p_M.y();
  const double eye =
      std::hypot((x - c.eye_x_mm) / c.eye_half_width_mm, (y - c.eye_y_mm) / c.eye_half_height_mm);
  if (eye < 1) return kFeature;
  if (x > c.brow_inner_x_mm && x < c.brow_outer_x_mm) {
    const double s = (x - c.brow_inner_x_mm) / (c.brow_outer_x_mm - c.brow_inner_x_mm);
    const double brow_y = c.brow_y_mm - c.brow_arch_mm * (1 - std::pow(2 * s - 1, 2));
    if (std::abs(y - brow_y) < c.brow_half_height_mm) return kFeature;
  }
  return kSkin;
}

}  // namespace

PaintedHead::PaintedHead(const HeadModelConfig& head, const Pinhole& camera)
    : config_(head),
      model_(head),
      camera_(camera),
      rgb_(static_cast<std::size_t>(3 * camera.width * camera.height)) {}

ImageView PaintedHead::Paint(const RigidTransform& X_KM) {
  const RigidTransform X_MK = X_KM.inverse();
  const Eigen::Vector3d& a = model_.semi_axes_m();
  const Eigen::Vector3d o = X_MK.translation().cwiseQuotient(a);
  std::uint8_t* out = rgb_.data();
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const Eigen::Vector3d ray = X_MK.linear() * Unproject(camera_, {x, y});
      const Eigen::Vector3d d = ray.cwiseQuotient(a);
      const double A = d.squaredNorm(), B = o.dot(d), D = B * B - A * (o.squaredNorm() - 1);
      Rgb color = kWall;
      if (D > 0)
        color = ColorAt(config_, model_, X_MK.translation() + (-B - std::sqrt(D)) / A * ray);
      *out++ = color.r;
      *out++ = color.g;
      *out++ = color.b;
    }
  }
  return {rgb_.data(),       camera_.width, camera_.height,
          3 * camera_.width, rgb_.size(),   PixelFormat::kRgb};
}

StereoRig TestRig() {
  const Pinhole camera{640, 480, 800, 800, 319.5, 239.5, {}};
  StereoRig rig{camera, camera, RigidTransform::Identity()};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

}  // namespace visavis
