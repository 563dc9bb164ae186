#include "services/recogniser/refined/icosphere.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/core/check.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

/// A direction this deep in a triangle is in no other, whatever the rounding.
constexpr float kSurelyInside = 1e-5f;

}  // namespace

Icosphere::Icosphere(int level) {
  VISAVIS_THROW_UNLESS(level >= 0 && level <= kMaxLevel, level);
  const float t = 0.5f * (1 + std::sqrt(5.0f));
  vertices_ = {{-1, t, 0},  {1, t, 0},  {-1, -t, 0}, {1, -t, 0}, {0, -1, t},  {0, 1, t},
               {0, -1, -t}, {0, 1, -t}, {t, 0, -1},  {t, 0, 1},  {-t, 0, -1}, {-t, 0, 1}};
  for (Vector3f& v : vertices_) v.normalize();
  triangles_.push_back({{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}});
  for (int i = 0; i < level; ++i) Subdivide();
  for (const auto& triangles : triangles_) planes_.push_back(PlanesOf(triangles));
}

std::vector<Icosphere::Planes> Icosphere::PlanesOf(const std::vector<Triangle>& triangles) const {
  std::vector<Planes> planes(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vector3f &a = vertex(triangles[i][0]), &b = vertex(triangles[i][1]),
                   &c = vertex(triangles[i][2]);
    planes[i].normals << b.cross(c).transpose(), c.cross(a).transpose(), a.cross(b).transpose();
  }
  return planes;
}

int Icosphere::LevelOf(std::size_t num_vertices) {
  for (int level = 0; level <= kMaxLevel; ++level) {
    if (num_vertices == 10 * (std::size_t{1} << (2 * level)) + 2) return level;
  }
  return -1;
}

void Icosphere::Subdivide() {
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [it, is_new] =
        middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(vertices_.size()));
    if (is_new) {
      const Vector3f sum = vertex(a) + vertex(b);
      vertices_.push_back(sum.normalized());
    }
    return it->second;
  };
  std::vector<Triangle> finer;
  finer.reserve(4 * triangles_.back().size());
  for (const auto& [a, b, c] : triangles_.back()) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    finer.push_back({a, ab, ca});
    finer.push_back({b, bc, ab});
    finer.push_back({c, ca, bc});
    finer.push_back({ab, bc, ca});
  }
  triangles_.push_back(std::move(finer));
}

// The triangle that the direction lies deepest in: rounding at an edge picks either neighbour.
std::size_t Icosphere::Deepest(const std::vector<Planes>& planes, std::size_t begin,
                               std::size_t end, const Vector3f& direction) const {
  std::size_t best = begin;
  float depth = -2;
  for (std::size_t t = begin; t < end; ++t) {
    const float least = planes[t].Shares(direction).minCoeff();
    if (least > depth) {
      depth = least;
      best = t;
      if (depth > kSurelyInside) break;
    }
  }
  return best;
}

std::size_t Icosphere::Descend(std::size_t level, std::size_t at, const Vector3f& d) const {
  while (++level < triangles_.size()) at = Deepest(planes_[level], 4 * at, 4 * at + 4, d);
  return at;
}

Icosphere::Place Icosphere::PlaceIn(std::size_t triangle, const Vector3f& d) const {
  Place place;
  place.corners = triangles_.back()[triangle];
  place.weights = planes_.back()[triangle].Shares(d).cwiseMax(0.0f);
  place.weights /= place.weights.sum();
  return place;
}

Icosphere::Place Icosphere::Locate(const Vector3f& direction) const {
  const Vector3f d = direction.normalized();
  return PlaceIn(Descend(0, Deepest(planes_[0], 0, planes_[0].size(), d), d), d);
}

// Up from the triangle to the smallest that surely holds the direction, and down again.
Icosphere::Place Icosphere::LocateNear(const Vector3f& direction, std::size_t* triangle) const {
  const Vector3f d = direction.normalized();
  std::size_t at = *triangle, level = planes_.size() - 1;
  while (planes_[level][at].Shares(d).minCoeff() <= kSurelyInside) {
    if (level == 0) {
      at = Deepest(planes_[0], 0, planes_[0].size(), d);
      break;
    }
    at /= 4;
    --level;
  }
  *triangle = Descend(level, at, d);
  return PlaceIn(*triangle, d);
}

}  // namespace visavis
