#include "services/recogniser/refined/head_table.h"

#include <cmath>
#include <utility>

#include "common/core/check.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

float Between(const Icosphere::Place& place, const std::vector<float>& values) {
  float sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += place.weights[static_cast<int>(i)] * values[static_cast<std::size_t>(place.corners[i])];
  }
  return sum;
}

const HeadTable& Checked(const HeadTable& table) {
  table.ValidateOrThrow();
  return table;
}

}  // namespace

void HeadTable::ValidateOrThrow() const {
  VISAVIS_THROW_UNLESS(Icosphere::LevelOf(radii_m.size()) >= 0, radii_m.size());
  VISAVIS_THROW_UNLESS(hair_side_m.empty() || hair_side_m.size() == radii_m.size(),
                       hair_side_m.size());
  VISAVIS_THROW_UNLESS(sigma_m.empty() || sigma_m.size() == radii_m.size(), sigma_m.size());
  for (const float radius : radii_m) {
    VISAVIS_THROW_UNLESS(radius >= kMinRadius_m && radius <= kMaxRadius_m, radius);
  }
  for (const float side : hair_side_m) VISAVIS_THROW_UNLESS(std::isfinite(side), side);
}

std::vector<Vector3f> VertexNormals(const std::vector<Vector3f>& vertices,
                                    const std::vector<Icosphere::Triangle>& triangles) {
  std::vector<Vector3f> normals(vertices.size(), Vector3f::Zero());
  for (const auto& triangle : triangles) {
    const auto at = [&](std::size_t i) { return vertices[static_cast<std::size_t>(triangle[i])]; };
    const Vector3f n = (at(1) - at(0)).cross(at(2) - at(0));
    for (const int i : triangle) normals[static_cast<std::size_t>(i)] += n;
  }
  for (Vector3f& n : normals) n.normalize();
  return normals;
}

TabulatedHead::TabulatedHead(HeadTable table)
    : table_(std::move(table)), sphere_(Icosphere::LevelOf(Checked(table_).radii_m.size())) {
  std::vector<Vector3f> surface = sphere_.vertices();
  for (std::size_t i = 0; i < surface.size(); ++i) surface[i] *= table_.radii_m[i];
  normals_ = VertexNormals(surface, sphere_.triangles());
}

float TabulatedHead::Radius(const Vector3f& direction) const {
  return Between(sphere_.Locate(direction), table_.radii_m);
}

float TabulatedHead::Sigma(const Vector3f& direction) const {
  return table_.sigma_m.empty() ? 0 : Between(sphere_.Locate(direction), table_.sigma_m);
}

float TabulatedHead::HairSide(const Vector3f& direction) const {
  return Between(sphere_.Locate(direction), table_.hair_side_m);
}

Vector3f TabulatedHead::Normal(const Vector3f& direction) const {
  const Icosphere::Place place = sphere_.Locate(direction);
  Vector3f sum = Vector3f::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    sum +=
        place.weights[static_cast<int>(i)] * normals_[static_cast<std::size_t>(place.corners[i])];
  }
  return sum.normalized();
}

}  // namespace visavis
