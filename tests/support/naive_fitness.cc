#include "tests/support/naive_fitness.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

struct Color {
  int r, g, b;
};

// The nearest pixel; outside the image white, of no hue.
Color PixelAt(const ImageView& image, const Eigen::Vector2d& uv) {
  const int x = static_cast<int>(std::floor(uv.x() + 0.5)),
            y = static_cast<int>(std::floor(uv.y() + 0.5));
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return {255, 255, 255};
  const std::uint8_t* p = image.row(y) + 3 * x;
  return {p[0], p[1], p[2]};
}

}  // namespace

int NaiveBrightness(int r, int g, int b) { return 255 - ((77 * r + 150 * g + 29 * b + 128) >> 8); }

bool NaiveIsSkin(int r, int g, int b, const ColorRuleConfig& rule) {
  const double max = std::max({r, g, b}), min = std::min({r, g, b});
  if (max == min) return false;
  double hue = 0;
  if (max == r) {
    hue = 60 * (g - b) / (max - min);
  } else if (max == g) {
    hue = 120 + 60 * (b - r) / (max - min);
  } else {
    hue = 240 + 60 * (r - g) / (max - min);
  }
  if (hue < 0) hue += 360;
  const double saturation = (max - min) / max;
  return hue > 0 && hue < 30 && max >= rule.skin_min_value &&
         saturation * 255 >= rule.skin_min_saturation - 1e-9;
}

bool NaiveIsHair(int r, int g, int b, const ColorRuleConfig& rule) {
  return NaiveBrightness(r, g, b) > rule.hair_min_p && !NaiveIsSkin(r, g, b, rule);
}

namespace {

// The disc's frame on the unit sphere that the ellipsoid becomes when each axis is divided by its
// length: w to the camera at distance d, e1 and e2 along the image's axes.
struct Disc {
  Disc(const Eigen::Vector3d& semi_axes, const Eigen::Vector3d& p_MK, const Eigen::Vector3d& x_M)
      : centre(p_MK.cwiseQuotient(semi_axes)), d(centre.norm()), w(centre / d) {
    // A direction along the image's x maps to the sphere by the transpose, so that the tilt of the
    // disc follows the image and not the ellipsoid.
    const Eigen::Vector3d x = x_M.cwiseProduct(semi_axes);
    e1 = (x - w * w.dot(x)).normalized();
    e2 = e1.cross(w);
    radius = std::sqrt(1 - 1 / (d * d));
  }
  Eigen::Vector3d centre;
  double d;
  Eigen::Vector3d w, e1, e2;
  double radius;
};

}  // namespace

Eigen::Vector3d NaiveFitness::SurfacePoint(double u, double v, const Eigen::Vector3d& p_MK,
                                           const Eigen::Vector3d& x_M) const {
  const Disc disc(model_.semi_axes_m(), p_MK, x_M);
  const Eigen::Vector3d flat = disc.radius * (u * disc.e1 + v * disc.e2);
  const Eigen::Vector3d on_sphere = flat + std::sqrt(1 - flat.squaredNorm()) * disc.w;
  return on_sphere.cwiseProduct(model_.semi_axes_m());
}

Eigen::Vector3d NaiveFitness::OutlinePoint(double u, double v, const Eigen::Vector3d& p_MK,
                                           const Eigen::Vector3d& x_M) const {
  const Disc disc(model_.semi_axes_m(), p_MK, x_M);
  const Eigen::Vector3d point = disc.radius * (u * disc.e1 + v * disc.e2) + disc.w / disc.d;
  return point.cwiseProduct(model_.semi_axes_m());
}

NaiveFitness::Terms NaiveFitness::EvaluateCamera(const ImageView& image, const Pinhole& camera,
                                                 const RigidTransform& X_KM) const {
  const RigidTransform X_MK = X_KM.inverse();
  const Eigen::Vector3d x_M = X_MK.linear().col(0);
  const auto color_at = [&](const Eigen::Vector3d& p_M) {  // Eqs. 17, 18, 20
    return PixelAt(image, Project(camera, X_KM * p_M).uv);
  };
  const auto p = [](const Color& c) { return static_cast<double>(NaiveBrightness(c.r, c.g, c.b)); };
  double site_in = 0, site_out = 0, color = 0, feat_in = 0, feat_out = 0;
  for (int i = 0; i < model_.num_in(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Eigen::Vector3d p_M =
        SurfacePoint(model_.in_u[k], model_.in_v[k], X_MK.translation(), x_M);
    const Color c = color_at(p_M);
    site_in += p(c);                                                                // Eq. 24
    const bool hair_part = model_.hair_normal().dot(p_M) > model_.hair_offset_m();  // Eq. 23
    color += hair_part ? NaiveIsHair(c.r, c.g, c.b, color_)
                       : NaiveIsSkin(c.r, c.g, c.b, color_);  // Eq. 28
  }
  for (int i = 0; i < model_.num_out(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    site_out +=
        p(color_at(OutlinePoint(model_.out_u[k], model_.out_v[k], X_MK.translation(), x_M)));
  }
  for (std::size_t i = 0; i < model_.feature_x.size(); ++i) {  // Eq. 30
    const double value =
        p(color_at({model_.feature_x[i], model_.feature_y[i], model_.feature_z[i]}));
    (static_cast<int>(i) < model_.num_feature_in() ? feat_in : feat_out) += value;
  }
  return {site_in / model_.num_in() / 255 - site_out / model_.num_out() / 255,
          color / model_.num_in(),
          feat_in / model_.num_feature_in() / 255 - feat_out / model_.num_feature_out() / 255};
}

Fitness NaiveFitness::Evaluate(const ImageView& right, const ImageView& left,
                               const Vector6d& phi) const {
  const RigidTransform X_CM = TransformFromPhi(phi);
  const Terms r = EvaluateCamera(right, rig_.right, X_CM);
  const Terms l = EvaluateCamera(left, rig_.left, rig_.X_CL.inverse() * X_CM);  // Eq. 19
  Fitness f;
  f.site = std::max(0.0, (r.site + l.site) / 2);  // Eq. 25
  f.color = (r.color + l.color) / 2;              // Eq. 29
  f.feat = (r.feat + l.feat) / 2;                 // Eq. 31
  f.total = f.site + f.color + f.feat;            // Eq. 32
  return f;
}

}  // namespace visavis
