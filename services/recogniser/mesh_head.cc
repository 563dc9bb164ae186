#include "services/recogniser/mesh_head.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "services/recogniser/direction_caster.h"
#include "services/recogniser/joined_mesh.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr int kLevel = 5;  ///< about 3.5 mm between directions
constexpr double kLeastHeight_m = 0.12, kMostHeight_m = 0.45;
constexpr double kLeastEyes_m = 0.04, kMostEyes_m = 0.09;
constexpr float kFold_m = 0.02f;       ///< the surface may fold over itself by
constexpr double kFoldedShare = 0.05;  ///< so many directions may meet a deeper fold
constexpr float kLowest_m = 0.14f;     ///< the neck is cut there
constexpr float kEverywhere_m = 0.1f;  ///< HairSide where there is no hair at all

template <typename... Words>
[[noreturn]] void Refuse(const Words&... words) {
  std::ostringstream text;
  (text << ... << words);
  throw std::invalid_argument(text.str());
}

/// Mean place of the triangles with @p label, weighted by area; of those with side * (x - middle)
/// > 0, where side is not 0.
std::optional<Vector3d> Centroid(const JoinedMesh& mesh, Label label, double side = 0,
                                 double middle = 0) {
  Vector3d sum = Vector3d::Zero();
  double total = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.labels[t] != label) continue;
    const auto at = [&](std::size_t i) -> Vector3d {
      return mesh.vertices[static_cast<std::size_t>(mesh.triangles[t][i])].cast<double>();
    };
    const Vector3d p = (at(0) + at(1) + at(2)) / 3;
    if (side != 0 && side * (p.x() - middle) <= 0) continue;
    const double area = (at(1) - at(0)).cross(at(2) - at(0)).norm();
    sum += area * p;
    total += area;
  }
  if (total <= 0) return std::nullopt;
  return sum / total;
}

struct Extent {
  Vector3d low, high;
};

Extent ExtentOf(const JoinedMesh& mesh) {
  Extent extent{Vector3d::Constant(1e9), Vector3d::Constant(-1e9)};
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (!IsHead(mesh.labels[t])) continue;
    for (const int i : mesh.triangles[t]) {
      const Vector3d p = mesh.vertices[static_cast<std::size_t>(i)].cast<double>();
      extent.low = extent.low.cwiseMin(p);
      extent.high = extent.high.cwiseMax(p);
    }
  }
  return extent;
}

struct Eyes {
  Vector3d middle;
  double distance;
};

Eyes FindEyes(const JoinedMesh& mesh, const Extent& extent) {
  const auto all = Centroid(mesh, Label::kEye);
  if (!all) Refuse("no eyes: a material must contain the word eye");
  const auto right = Centroid(mesh, Label::kEye, 1, all->x());
  const auto left = Centroid(mesh, Label::kEye, -1, all->x());
  if (!right || !left) Refuse("one eye: must be two, to both sides of x = ", all->x(), " m");
  const Eyes eyes{0.5 * (*right + *left), (*right - *left).norm()};
  if (!(eyes.distance >= kLeastEyes_m && eyes.distance <= kMostEyes_m)) {
    Refuse("eyes are ", eyes.distance, " m apart: must be ", kLeastEyes_m, " to ", kMostEyes_m,
           " m; is the scale right?");
  }
  if (eyes.middle.z() > 0.5 * (extent.low.z() + extent.high.z())) {
    Refuse("eyes lie behind the head's middle: must look to -z; is y_up right?");
  }
  return eyes;
}

HeadShape Landmarks(const JoinedMesh& mesh, const Eyes& eyes) {
  HeadShape shape;
  const HeadShape adult;
  const auto y_of = [&](Label label) -> std::optional<float> {
    const auto p = Centroid(mesh, label);
    if (!p) return std::nullopt;
    return adult.eye_y + static_cast<float>(p->y() - eyes.middle.y());
  };
  shape.eye_x = static_cast<float>(0.5 * eyes.distance);
  if (const auto brow = y_of(Label::kBrow)) shape.brow_y = *brow;
  if (const auto lips = y_of(Label::kLips)) {
    if (*lips < shape.eye_y + 0.03f) {
      Refuse("mouth lies ", *lips - shape.eye_y, " m below the eyes: must be 0.03 m or more");
    }
    shape.mouth_y = *lips;
    const float stretch = (*lips - adult.eye_y) / (adult.mouth_y - adult.eye_y);
    shape.nostril_y = adult.eye_y + stretch * (adult.nostril_y - adult.eye_y);
  }
  if (const auto nostrils = y_of(Label::kNostril)) shape.nostril_y = *nostrils;
  return shape;
}

/// Distance to the nearest direction of the other kind, as a length on the surface.
std::vector<float> HairSides(const Icosphere& sphere, const std::vector<float>& radii,
                             const std::vector<bool>& is_hair) {
  std::vector<std::size_t> hair, skin;
  for (std::size_t i = 0; i < is_hair.size(); ++i) (is_hair[i] ? hair : skin).push_back(i);
  std::vector<float> sides(is_hair.size(), hair.empty() ? -kEverywhere_m : kEverywhere_m);
  if (hair.empty() || skin.empty()) return sides;
  std::vector<Vector3f> surface = sphere.vertices();
  for (std::size_t i = 0; i < surface.size(); ++i) surface[i] *= radii[i];
  const auto measure = [&](const std::vector<std::size_t>& from, const std::vector<std::size_t>& to,
                           float sign) {
    for (const std::size_t i : from) {
      float nearest = std::numeric_limits<float>::max(), radius = 0;
      for (const std::size_t k : to) {
        const float d = (surface[i] - surface[k]).squaredNorm();
        if (d < nearest) {
          nearest = d;
          radius = radii[k];
        }
      }
      // The border lies about half a step of the grid before the other kind.
      const float step = 0.5f * 0.035f * 0.5f * (radii[i] + radius);
      sides[i] = sign * std::max(std::sqrt(nearest) - step, 0.5f * step);
    }
  };
  measure(hair, skin, 1);
  measure(skin, hair, -1);
  return sides;
}

}  // namespace

HeadGeometry HeadFromMesh(const std::vector<LabelledPart>& parts, Vector3d* p_M_of_mesh) {
  JoinedMesh mesh = JoinParts(parts);
  const Extent extent = ExtentOf(mesh);
  const double height = extent.high.y() - extent.low.y();
  if (!(height >= kLeastHeight_m && height <= kMostHeight_m)) {
    Refuse("head is ", std::max(height, 0.0), " m high: must be ", kLeastHeight_m, " to ",
           kMostHeight_m, " m; is the scale right?");
  }
  const Eyes eyes = FindEyes(mesh, extent);
  const HeadShape shape = Landmarks(mesh, eyes);
  const Vector3d p_M = eyes.middle - AdultEyes();
  for (Vector3f& p : mesh.vertices) p -= p_M.cast<float>();
  if (p_M_of_mesh) *p_M_of_mesh = p_M;

  const Icosphere sphere(kLevel);
  const std::vector<DirectionHits> hits = CastDirections(mesh, sphere);
  HeadTable table;
  std::vector<bool> is_hair;
  std::size_t folded = 0;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Vector3f& d = sphere.vertices()[i];
    if (!hits[i].any()) {
      Refuse("lies beside its middle ", 1e3 * p_M.transpose(),
             " mm, which follows from the eyes: must enclose it");
    }
    folded += hits[i].deepest_fold > kFold_m;
    const DirectionHits::Hit& hit = hits[i].outermost();
    const float lowest = d.y() > 0 ? kLowest_m / d.y() : HeadTable::kMaxRadius_m;
    table.radii_m.push_back(
        std::clamp(std::min(hit.radius, lowest), HeadTable::kMinRadius_m, HeadTable::kMaxRadius_m));
    const bool beard = hit.radius * d.y() > shape.nostril_y - 0.01f && d.z() < 0;
    is_hair.push_back(hit.label == Label::kHair && !beard);
  }
  const double share = static_cast<double>(folded) / static_cast<double>(hits.size());
  if (share > kFoldedShare) {
    Refuse("is not star-shaped: in ", std::lround(100 * share),
           " % of the directions from its middle it folds over itself by more than ",
           1e3 * static_cast<double>(kFold_m), " mm: must be at most ", 100 * kFoldedShare, " %");
  }
  table.hair_side_m = HairSides(sphere, table.radii_m, is_hair);
  return {HeadSurface(shape, table), Vector3d::Zero()};
}

}  // namespace visavis
