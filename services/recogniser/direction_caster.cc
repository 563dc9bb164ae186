#include "services/recogniser/direction_caster.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

/// Directions in cells of height (along y), so that a triangle asks only those that it may cover.
class Belts {
 public:
  explicit Belts(const std::vector<Vector3f>& directions) : members_(kBelts) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
      members_[BeltOf(directions[i].y())].push_back(i);
    }
  }
  template <typename Visit>
  void Between(float low_y, float high_y, const Visit& visit) const {
    for (std::size_t b = BeltOf(low_y); b <= BeltOf(high_y); ++b) {
      for (const std::size_t i : members_[b]) visit(i);
    }
  }

 private:
  static constexpr std::size_t kBelts = 128;
  static std::size_t BeltOf(float y) {
    const float at = 0.5f * (y + 1) * static_cast<float>(kBelts);
    return static_cast<std::size_t>(std::clamp(at, 0.0f, static_cast<float>(kBelts - 1)));
  }
  std::vector<std::vector<std::size_t>> members_;
};

void Take(float radius, Label label, DirectionHits* hits) {
  DirectionHits::Hit* hit = label == Label::kEar ? &hits->ear
                            : IsHead(label)      ? &hits->head
                                                 : &hits->neck;
  if (radius > hit->radius) *hit = {radius, label};
  if (hit != &hits->head) return;
  hits->innermost = std::min(hits->innermost, radius);
  hits->deepest_fold = hits->head.radius - hits->innermost;
}

}  // namespace

std::vector<DirectionHits> CastDirections(const JoinedMesh& mesh, const Icosphere& sphere) {
  const std::vector<Vector3f>& directions = sphere.vertices();
  const Belts belts(directions);
  std::vector<DirectionHits> hits(directions.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto at = [&](std::size_t i) {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])];
    };
    const Vector3f a = at(0), b = at(1), c = at(2);
    const Vector3f n = (b - a).cross(c - a);
    const float volume = n.dot(a);
    if (a.norm() < 1e-6f || b.norm() < 1e-6f || c.norm() < 1e-6f || volume == 0) continue;
    // A cone round the triangle as seen from the origin.
    const Vector3f middle = (a.normalized() + b.normalized() + c.normalized()).normalized();
    const float cosine = std::min(
        {middle.dot(a.normalized()), middle.dot(b.normalized()), middle.dot(c.normalized())});
    const float sine = cosine > 0 ? std::sqrt(std::max(0.0f, 1 - cosine * cosine)) : 1.0f;
    const float slack = 1e-5f, reach = cosine > 0 ? sine + 1 - cosine + slack : 2.0f;
    const Vector3f bc = b.cross(c), ca = c.cross(a), ab = a.cross(b);
    belts.Between(middle.y() - reach, middle.y() + reach, [&](std::size_t i) {
      const Vector3f& d = directions[i];
      if (d.dot(middle) < cosine - slack) return;
      Vector3f shares(d.dot(bc), d.dot(ca), d.dot(ab));
      if (volume < 0) shares = -shares;  // seen from behind
      const float edge = -1e-6f * shares.cwiseAbs().sum();
      if (shares.minCoeff() < edge) return;
      const float radius = volume / n.dot(d);
      if (radius > 0) Take(radius, mesh.labels[t], &hits[i]);
    });
  }
  return hits;
}

}  // namespace visavis
