#include "tests/people/head_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/recogniser/refined/head_geometry.h"
#include "services/simulator/actor.h"
#include "services/simulator/mesh_file.h"

namespace visavis {
namespace {

constexpr float kOutside_m = 0.45f;      ///< from M's origin: beyond all of a head
constexpr double kEyeball_m = 0.012;     ///< radius
constexpr float kBeardBelow_m = 0.049f;  ///< hair of the front below this height, y in M, is beard
constexpr float kNeckZ_m = 0.03f, kNeck_m = 0.05f;  ///< within the neck of all: its axis, radius
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

bool IsFile(const std::string& source) {
  return source.size() > 4 && source.compare(source.size() - 4, 4, ".obj") == 0;
}

bool IsBare(Label label) {
  return (IsHead(label) || label == Label::kNeck) && label != Label::kHair &&
         label != Label::kBrow && label != Label::kLash;
}

/// Mean place of what is labelled eye, weighted by area.
Eigen::Vector3d EyeballsOf(const Figure& figure) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0;
  for (const Part& part : figure.head) {
    if (part.texture.at(0, 0).label != Label::kEye) continue;
    for (const auto& [i, j, k] : part.mesh.triangles) {
      const auto at = [&](std::uint32_t v) { return part.mesh.vertices[v].cast<double>(); };
      const Eigen::Vector3d a = at(i), b = at(j), c = at(k);
      const double area = (b - a).cross(c - a).norm();
      sum += area / 3 * (a + b + c);
      total += area;
    }
  }
  return sum / total;
}

Figure BaldFigure(Subject subject) {
  subject.hair.kind = HairStyle::Kind::kBald;
  subject.hair.beard = 0;
  FigureDetail detail;
  detail.texture_size = 64;
  return BuildFigure(subject, detail);
}

}  // namespace

HeadScan::HeadScan(const std::string& source) : is_procedural_(!IsFile(source)) {
  if (is_procedural_) {
    const Subject subject = NamedSubject(source);
    const Figure figure = BuildFigure(subject);
    p_TE_m_ = 0.5 * (figure.p_M_eye_right_m + figure.p_M_eye_left_m);
    dressed_.Take(figure.head, false);
    dressed_.Take(figure.body, false);
    bare_.Take(BaldFigure(subject).head, false);
  } else {
    const Figure figure = LoadFigure(source, {});
    p_TE_m_ = EyeballsOf(figure) - Eigen::Vector3d(0, 0, kEyeball_m);
    dressed_.Take(figure.head, false);
    dressed_.Take(figure.body, false);
    bare_.Take(figure.head, true);
  }
}

void HeadScan::Rays::Take(const std::vector<Part>& parts, bool bare) {
  const Actor actor(parts, false);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Label label = parts[i].texture.at(0, 0).label;
    if (bare && !IsBare(label)) continue;
    const Mesh& mesh = parts[i].mesh;
    scene.Add(mesh.vertices, mesh.triangles);
    pieces.push_back({mesh.vertices, mesh.triangles, actor.parts()[i].labels});
  }
  scene.Commit();
}

RigidTransform HeadScan::X_TM_by_eyes() const {
  Eigen::Vector3d p_TM = p_TE_m_ - AdultEyes();
  p_TM.x() = 0;
  return MakeTransform(Eigen::Matrix3d::Identity(), p_TM);
}

HeadScan::Hit HeadScan::Cast(const Rays& rays, const RigidTransform& X_TM,
                             const Eigen::Vector3f& direction) {
  const float lowest = direction.y() > 0 ? kLowest_m / direction.y() : kOutside_m;
  const float from = std::min(lowest, kOutside_m);
  const Eigen::Vector3f along_T = -(X_TM.linear().cast<float>() * direction);
  RayBatch batch;
  batch.size = 1;
  batch.dx[0] = along_T.x();
  batch.dy[0] = along_T.y();
  batch.dz[0] = along_T.z();
  batch.t[0] = from;
  rays.scene.Intersect(X_TM.translation().cast<float>() - from * along_T, &batch);
  if (!batch.hit[0]) return {kNone, Label::kBackground, true};
  const Piece& piece = rays.pieces[batch.mesh[0]];
  const auto& [i, j, k] = piece.triangles[batch.triangle[0]];
  const Eigen::Vector3f &a = piece.vertices[i], &b = piece.vertices[j], &c = piece.vertices[k];
  return {from - batch.t[0], piece.labels[batch.triangle[0]],
          (b - a).cross(c - a).dot(along_T) > 0};
}

float HeadScan::BareRadius(const RigidTransform& X_TM, const Eigen::Vector3f& direction) const {
  const Hit hit = Cast(bare_, X_TM, direction);
  if (!hit.is_from_inside) return hit.radius_m;
  // The neck is open below: who starts in it meets the skin from inside. So do rays through holes
  // that clothes cover; what they meet tells nothing.
  const float lowest = kLowest_m / std::max(direction.y(), 1e-3f);
  const Eigen::Vector3f p = lowest * direction;
  return std::hypot(p.x(), p.z() - kNeckZ_m) < kNeck_m ? lowest : kNone;
}

HeadScan::Outermost HeadScan::OutermostAt(const RigidTransform& X_TM,
                                          const Eigen::Vector3f& direction) const {
  const float bare = BareRadius(X_TM, direction);
  const Hit hit = Cast(dressed_, X_TM, direction);
  if (hit.radius_m < bare || std::isnan(hit.radius_m)) return {bare, false};
  if (hit.label == Label::kClothes) return {hit.radius_m, false};
  const bool is_beard = hit.radius_m * direction.y() > kBeardBelow_m && direction.z() < 0;
  // Hair has no inside.
  if (hit.label == Label::kHair) return {hit.radius_m, !is_beard};
  return {hit.is_from_inside ? bare : hit.radius_m, false};
}

}  // namespace visavis
