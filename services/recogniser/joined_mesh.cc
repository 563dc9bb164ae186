#include "services/recogniser/joined_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace visavis {
namespace {

constexpr float kSamePlace_m = 2e-6f;

/// The places of corners, each once: files repeat them at seams, to a rounding error.
class Places {
 public:
  explicit Places(std::vector<Eigen::Vector3f>* places) : places_(*places) {}

  std::int32_t IndexOf(const Eigen::Vector3f& p) {
    const Cell own = CellOf(p);
    for (int i = -1; i <= 1; ++i) {
      for (int j = -1; j <= 1; ++j) {
        for (int k = -1; k <= 1; ++k) {
          const auto found =
              cells_.find({std::get<0>(own) + i, std::get<1>(own) + j, std::get<2>(own) + k});
          if (found == cells_.end()) continue;
          const Eigen::Vector3f& q = places_[static_cast<std::size_t>(found->second)];
          if ((p - q).cwiseAbs().maxCoeff() < kSamePlace_m) return found->second;
        }
      }
    }
    const auto index = static_cast<std::int32_t>(places_.size());
    places_.push_back(p);
    cells_[own] = index;
    return index;
  }

 private:
  using Cell = std::tuple<long, long, long>;
  static Cell CellOf(const Eigen::Vector3f& p) {
    return {std::lround(p.x() / kSamePlace_m), std::lround(p.y() / kSamePlace_m),
            std::lround(p.z() / kSamePlace_m)};
  }
  std::vector<Eigen::Vector3f>& places_;
  std::map<Cell, std::int32_t> cells_;
};

}  // namespace

JoinedMesh JoinParts(const std::vector<LabelledPart>& parts) {
  JoinedMesh mesh;
  Places places(&mesh.vertices);
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (const LabelledPart& part : parts) {
    if (part.label == Label::kClothes) continue;
    std::vector<std::int32_t> joined;
    for (const Eigen::Vector3f& p : part.vertices) joined.push_back(places.IndexOf(p));
    for (const auto& corners : part.triangles) {
      const std::array<std::int32_t, 3> t = {joined[corners[0]], joined[corners[1]],
                                             joined[corners[2]]};
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;  // drawn out to a line
      mesh.triangles.push_back(t);
      mesh.labels.push_back(part.label);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::int32_t a = t[i], b = t[(i + 1) % 3];
        ++edges[{std::min(a, b), std::max(a, b)}];
      }
    }
  }
  int open = 0;
  const std::pair<const std::pair<std::int32_t, std::int32_t>, int>* first = nullptr;
  for (const auto& edge : edges) {
    if (edge.second == 2) continue;
    if (open++ == 0) first = &edge;
  }
  if (open > 0) {
    const Eigen::Vector3f& a = mesh.vertices[static_cast<std::size_t>(first->first.first)];
    const Eigen::Vector3f& b = mesh.vertices[static_cast<std::size_t>(first->first.second)];
    std::ostringstream text;
    text << "is not closed: " << open << " of " << edges.size()
         << " edges have not two triangles (the first, from " << a.transpose() << " to "
         << b.transpose() << " m, has " << first->second << "): each must have two";
    throw std::invalid_argument(text.str());
  }
  return mesh;
}

}  // namespace visavis
