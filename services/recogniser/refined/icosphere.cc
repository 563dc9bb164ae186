#include "services/recogniser/refined/icosphere.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/core/check.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

/// Volumes spanned with @p d: all >= 0 where d leads through the triangle a, b, c.
Vector3f Shares(const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& d) {
  return {d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b))};
}

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

Icosphere::Place Icosphere::Locate(const Vector3f& direction) const {
  const Vector3f d = direction.normalized();
  // Of the candidates that which d lies deepest in: rounding at an edge picks either neighbour.
  const auto deepest = [&](const std::vector<Triangle>& triangles, std::size_t begin,
                           std::size_t end) {
    std::size_t best = begin;
    float depth = -2;
    for (std::size_t t = begin; t < end; ++t) {
      const auto& [a, b, c] = triangles[t];
      const float least = Shares(vertex(a), vertex(b), vertex(c), d).minCoeff();
      if (least > depth) {
        depth = least;
        best = t;
      }
    }
    return best;
  };
  std::size_t at = deepest(triangles_[0], 0, triangles_[0].size());
  for (std::size_t level = 1; level < triangles_.size(); ++level) {
    at = deepest(triangles_[level], 4 * at, 4 * at + 4);
  }
  Place place;
  place.corners = triangles_.back()[at];
  const auto& [a, b, c] = place.corners;
  place.weights = Shares(vertex(a), vertex(b), vertex(c), d).cwiseMax(0.0f);
  place.weights /= place.weights.sum();
  return place;
}

}  // namespace visavis
