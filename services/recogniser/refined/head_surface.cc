#include "services/recogniser/refined/head_surface.h"

namespace visavis {

using Eigen::Vector3f;

HeadSurface::HeadSurface(const HeadShape& shape, const HeadTable& table)
    : shape_(shape), table_(std::make_shared<const TabulatedHead>(table)) {}

float HeadSurface::Radius(const Vector3f& direction) const { return table_->Radius(direction); }

float HeadSurface::Sigma(const Vector3f& direction) const { return table_->Sigma(direction); }

float HeadSurface::HairSide(const Vector3f& p) const {
  if (table_->has_hair_side()) return table_->HairSide(p);
  return shape_.hair_normal().dot(p) - shape_.hair_offset;
}

Vector3f HeadSurface::IntoHair(const Vector3f& p) const {
  const Vector3f n = NormalAt(p);
  Vector3f towards = shape_.hair_normal();
  if (table_->has_hair_side()) {
    const Vector3f a = n.unitOrthogonal(), b = n.cross(a);
    constexpr float kStep = 0.004f;
    towards = (HairSide(p + kStep * a) - HairSide(p - kStep * a)) * a +
              (HairSide(p + kStep * b) - HairSide(p - kStep * b)) * b;
  }
  return (towards - n * n.dot(towards)).normalized();
}

Vector3f HeadSurface::Onto(const Vector3f& p) const {
  const Vector3f direction = p.normalized();
  return Radius(direction) * direction;
}

Vector3f HeadSurface::NormalAt(const Vector3f& p) const { return table_->Normal(p); }

}  // namespace visavis
