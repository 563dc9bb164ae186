#include "services/recogniser/refined/head_surface.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kBlend = 0.012f;  ///< [m] where the two bodies differ by less, they melt together

float SmoothStep(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

float Gaussian(float x, float sigma) { return std::exp(-0.5f * x * x / (sigma * sigma)); }

/// Where the ray from the origin leaves the superellipsoid; 0 where the origin is outside of it.
float RayLeaves(const Vector3f& direction, const Vector3f& centre, const Vector3f& axes, float e) {
  const auto level = [&](float r) {
    const Vector3f q = (r * direction - centre).cwiseAbs().cwiseQuotient(axes);
    return std::pow(q.x(), e) + std::pow(q.y(), e) + std::pow(q.z(), e);
  };
  if (level(0) >= 1) return 0;
  float inside = 0, outside = 0.4f;
  for (int i = 0; i < 22; ++i) {
    const float middle = 0.5f * (inside + outside);
    (level(middle) < 1 ? inside : outside) = middle;
  }
  return inside;
}

}  // namespace

HeadSurface::HeadSurface(const HeadShape& shape)
    : shape_(shape),
      hair_normal_(0, -std::sin(shape.hair_tilt_rad), std::cos(shape.hair_tilt_rad)) {}

HeadSurface::HeadSurface(const HeadShape& shape, const HeadTable& table) : HeadSurface(shape) {
  table_ = std::make_shared<const TabulatedHead>(table);
}

float HeadSurface::HairSide(const Vector3f& p) const {
  if (table_ && table_->has_hair_side()) return table_->HairSide(p);
  return hair_normal_.dot(p) - shape_.hair_offset;
}

Vector3f HeadSurface::IntoHair(const Vector3f& p) const {
  const Vector3f n = NormalAt(p);
  Vector3f towards = hair_normal_;
  if (table_ && table_->has_hair_side()) {
    const Vector3f a = n.unitOrthogonal(), b = n.cross(a);
    constexpr float kStep = 0.004f;
    towards = (HairSide(p + kStep * a) - HairSide(p - kStep * a)) * a +
              (HairSide(p + kStep * b) - HairSide(p - kStep * b)) * b;
  }
  return (towards - n * n.dot(towards)).normalized();
}

float HeadSurface::Radius(const Vector3f& direction) const {
  if (table_) return table_->Radius(direction);
  const HeadShape& s = shape_;
  const float cranium = RayLeaves(direction, s.cranium_centre, s.cranium, s.cranium_exponent);
  const float face = RayLeaves(direction, s.face_centre, s.face, s.face_exponent);
  const float near = std::max(kBlend - std::abs(cranium - face), 0.0f);
  float r = std::max(cranium, face) + near * near / (4 * kBlend);

  const Vector3f p = r * direction;
  const float up = std::max(-direction.y(), 0.0f), behind = std::max(direction.z(), 0.0f);
  r += s.hair * (1 + 0.6f * up + 0.4f * behind) * SmoothStep(-0.006f, 0.018f, HairSide(p));
  if (p.z() >= 0.005f) return r;
  const float tip_y = s.nostril_y - 0.012f;
  const float along = (p.y() - s.eye_y) / (tip_y - s.eye_y);
  const float ridge = along < 0   ? 0.2f * s.nose * SmoothStep(s.brow_y, s.eye_y, p.y())
                      : along < 1 ? s.nose * (0.2f + 0.8f * along)
                                  : std::max(0.0f, s.nose * (1 - (p.y() - tip_y) / 0.012f));
  r += ridge * Gaussian(p.x(), 0.007f + 0.1f * std::max(0.0f, p.y() - s.eye_y));
  for (const float side : {-1.0f, 1.0f}) {
    r -= 0.0045f * Gaussian(p.x() - side * s.eye_x, 0.012f) * Gaussian(p.y() - s.eye_y, 0.008f);
  }
  return r;
}

Vector3f HeadSurface::Onto(const Vector3f& p) const {
  const Vector3f direction = p.normalized();
  return Radius(direction) * direction;
}

Vector3f HeadSurface::NormalAt(const Vector3f& p) const {
  if (table_) return table_->Normal(p);
  const Vector3f d = p.normalized();
  const Vector3f a = d.unitOrthogonal(), b = d.cross(a);
  constexpr float kStep = 0.03f;
  const Vector3f along_a = Onto(d + kStep * a) - Onto(d - kStep * a);
  const Vector3f along_b = Onto(d + kStep * b) - Onto(d - kStep * b);
  return along_a.cross(along_b).normalized();
}

}  // namespace visavis
