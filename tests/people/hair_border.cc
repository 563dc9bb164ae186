#include "tests/people/hair_border.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kNoBorder_m = 0.1f;  ///< where all have hair, or none

using Segment = std::pair<Vector3f, Vector3f>;

float Distance(const Vector3f& p, const Segment& segment) {
  const Vector3f along = segment.second - segment.first;
  const float length = along.squaredNorm();
  const float t = length > 0 ? (p - segment.first).dot(along) / length : 0;
  return (p - segment.first - std::clamp(t, 0.0f, 1.0f) * along).norm();
}

}  // namespace

std::vector<float> HairSides(const Icosphere& sphere, const std::vector<float>& radii_m,
                             const std::vector<double>& hair_share) {
  std::vector<Vector3f> surface = sphere.vertices();
  for (std::size_t i = 0; i < surface.size(); ++i) surface[i] *= radii_m[i];
  std::vector<Segment> border;
  for (const Icosphere::Triangle& corners : sphere.triangles()) {
    std::vector<Vector3f> crossings;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<std::size_t>(corners[k]),
                 b = static_cast<std::size_t>(corners[(k + 1) % 3]);
      const double from = hair_share[a] - 0.5, to = hair_share[b] - 0.5;
      if ((from > 0) == (to > 0)) continue;
      const auto t = static_cast<float>(from / (from - to));
      crossings.push_back(surface[a] + t * (surface[b] - surface[a]));
    }
    if (crossings.size() == 2) border.emplace_back(crossings[0], crossings[1]);
  }
  std::vector<float> sides;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    float nearest = border.empty() ? kNoBorder_m : 1e9f;
    for (const Segment& segment : border)
      nearest = std::min(nearest, Distance(surface[i], segment));
    sides.push_back(hair_share[i] > 0.5 ? nearest : -nearest);
  }
  return sides;
}

}  // namespace visavis
