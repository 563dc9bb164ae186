#include "services/recogniser/refined/mesh_fitness.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kScoreLimit = 50;
constexpr double kScoreUnit = 40;  ///< 2 nats
constexpr float kGrazing = 0.22f;  ///< cosine below which a vertex lies at the outline
constexpr double kNccWeight = 1.5;
constexpr int kFewestPattern = 20;

struct PixelOf {
  float u, v;
};

PixelOf Project(const EyeGeometry& g, const Vector3f& p) {
  const float iz = 1 / std::max(p.z(), 0.05f);
  return {g.cx + g.fx * p.x() * iz, g.cy + g.fy * p.y() * iz};
}

}  // namespace

double MeshScore::total() const {
  return (has_color ? 0.5 * (inside - std::max(outside, -1.0)) : 0) +
         (has_ncc ? kNccWeight * ncc : 0);
}

MeshFitness::Point MeshFitness::MakePoint(const Vector3f& p, const Vector3f& n) {
  return {p, n, n.dot(p), 0, false};
}

MeshFitness::MeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail) {
  const auto step = static_cast<std::size_t>(detail);
  std::size_t inside = 0, outline = 0, pattern = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Point point = MakePoint(mesh.vertices[i], mesh.normals[i]);
    point.hair = mesh.parts[i] == HeadPart::kHair;
    if (mesh.coloured[i] && inside++ % (2 * step) == 0) inside_.push_back(point);
    if (mesh.contour_weights[i] > 0 && outline++ % step == 0) outline_.push_back(point);
  }
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!face.has_generic[i] || pattern++ % (2 * step) != 0) continue;
    pattern_.push_back(MakePoint(face.points[i], face.normals[i]));
    pattern_.back().value = face.generic[kCoarseBand][i];
  }
  // Forehead, cheeks, nose, upper lip, chin.
  for (const auto& [x, y] : {std::pair{-0.02f, -0.019f},
                             {0.02f, -0.019f},
                             {-0.035f, 0.038f},
                             {0.035f, 0.038f},
                             {0.0f, 0.038f},
                             {0.0f, 0.068f},
                             {-0.03f, 0.073f},
                             {0.03f, 0.073f},
                             {0.0f, 0.096f}}) {
    const Vector3f wanted(x, y, -0.085f);
    skin_.push_back(std::min_element(
        mesh.vertices.begin(), mesh.vertices.end(), [&](const Vector3f& a, const Vector3f& b) {
          return (a - wanted).squaredNorm() < (b - wanted).squaredNorm();
        })[0]);
  }
}

double MeshFitness::GlanceAtSkin(const StereoView& view, const RigidTransform& X_CM) const {
  int sum = 0, count = 0;
  for (const EyeView& eye : view) {
    if (!eye.seen() || !eye.scores->has_color()) continue;
    const EyePose pose(*eye.geometry, X_CM);
    for (const Vector3f& p : skin_) {
      const PixelOf at = Project(*eye.geometry, pose.InEye(p));
      sum += std::clamp(SkinScore(eye.scores->At(at.u, at.v)), -kScoreLimit, kScoreLimit);
      ++count;
    }
  }
  return count > 0 ? sum / (kScoreUnit * count) : 1;
}

MeshScore MeshFitness::Evaluate(const StereoView& view, const RigidTransform& X_CM) const {
  MeshScore score;
  int color_eyes = 0, ncc_eyes = 0;
  for (const EyeView& eye : view) {
    if (!eye.seen()) continue;
    const EyePose pose(*eye.geometry, X_CM);
    score.ncc += Correlation(eye, pose);
    ++ncc_eyes;
    if (!eye.scores->has_color()) continue;
    score.inside += Inside(eye, pose);
    score.outside += Outside(eye, pose);
    ++color_eyes;
  }
  score.has_color = color_eyes > 0;
  score.has_ncc = ncc_eyes > 0;
  score.inside /= std::max(color_eyes, 1);
  score.outside /= std::max(color_eyes, 1);
  score.ncc /= std::max(ncc_eyes, 1);
  return score;
}

double MeshFitness::Inside(const EyeView& eye, const EyePose& pose) const {
  int count = 0, sum = 0;
  for (const Point& point : inside_) {
    if (point.n_dot_p >= point.n.dot(pose.p_ME)) continue;  // turned away
    const PixelOf at = Project(*eye.geometry, pose.InEye(point.p));
    const PackedScores s = eye.scores->At(at.u, at.v);
    sum += std::clamp(point.hair ? HairScore(s) : SkinScore(s), -kScoreLimit, kScoreLimit);
    ++count;
  }
  return static_cast<double>(sum) / (kScoreUnit * std::max(count, 1));
}

double MeshFitness::Outside(const EyeView& eye, const EyePose& pose) const {
  int count = 0, sum = 0;
  const float grazing = -kGrazing * pose.p_ME.norm();
  for (const Point& point : outline_) {
    const float away = point.n_dot_p - point.n.dot(pose.p_ME);  // < 0: turned to the eye
    if (away >= 0 || away <= grazing) continue;
    for (const float beyond : {0.010f, 0.022f}) {
      const PixelOf at = Project(*eye.geometry, pose.InEye(point.p + beyond * point.n));
      sum += std::clamp(HeadScore(eye.scores->At(at.u, at.v)), -kScoreLimit, kScoreLimit);
      ++count;
    }
  }
  return static_cast<double>(sum) / (kScoreUnit * std::max(count, 1));
}

double MeshFitness::Correlation(const EyeView& eye, const EyePose& pose) const {
  int n = 0;
  float x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  const float turned = -0.2f * pose.p_ME.norm();
  for (const Point& point : pattern_) {
    if (point.n_dot_p - point.n.dot(pose.p_ME) > turned) continue;
    const PixelOf at = Project(*eye.geometry, pose.InEye(point.p));
    float value;
    if (!eye.bands->Nearest(kCoarseBand, at.u, at.v, &value)) continue;
    x += point.value;
    y += value;
    xx += point.value * point.value;
    xy += point.value * value;
    yy += value * value;
    ++n;
  }
  if (n < kFewestPattern) return 0;
  const float in = 1 / static_cast<float>(n);
  const float cov = xy - x * y * in, vx = xx - x * x * in, vy = yy - y * y * in;
  return static_cast<double>(cov / std::sqrt(std::max(vx * vy, 0.0f) + 1e-6f));
}

}  // namespace visavis
