#include "services/recogniser/joined_mesh.h"

#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace visavis {

// Corners at the same place, to the bit, are one: files repeat them at seams.
JoinedMesh JoinParts(const std::vector<LabelledPart>& parts) {
  JoinedMesh mesh;
  std::map<std::tuple<float, float, float>, std::int32_t> places;
  std::map<std::pair<std::int32_t, std::int32_t>, int> edges;
  for (const LabelledPart& part : parts) {
    if (part.label == Label::kClothes) continue;
    std::vector<std::int32_t> joined;
    for (const Eigen::Vector3f& p : part.vertices) {
      const auto [it, is_new] = places.try_emplace({p.x(), p.y(), p.z()},
                                                   static_cast<std::int32_t>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(p);
      joined.push_back(it->second);
    }
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
