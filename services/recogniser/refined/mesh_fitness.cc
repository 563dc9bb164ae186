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

MeshFitness::MeshFitness(const HeadMesh& mesh, const FacePoints& face) : face_(face) {
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vector3f &p = mesh.vertices[i], &n = mesh.normals[i];
    vertices_.push_back({p, n, n.dot(p), mesh.parts[i] == HeadPart::kHair, mesh.coloured[i] != 0,
                         mesh.contour_weights[i] > 0});
  }
  // Forehead, cheeks, nose, upper lip, chin.
  for (const auto& [x, y] : {std::pair{-0.02f, -0.012f},
                             {0.02f, -0.012f},
                             {-0.035f, 0.045f},
                             {0.035f, 0.045f},
                             {0.0f, 0.045f},
                             {0.0f, 0.075f},
                             {-0.03f, 0.08f},
                             {0.03f, 0.08f},
                             {0.0f, 0.103f}}) {
    const Vector3f wanted(x, y, -0.09f);
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

MeshScore MeshFitness::Evaluate(const StereoView& view, const RigidTransform& X_CM,
                                const std::vector<float>& pattern,
                                const std::vector<unsigned char>& usable, int stride) const {
  MeshScore score;
  int color_eyes = 0, ncc_eyes = 0;
  for (const EyeView& eye : view) {
    if (!eye.seen()) continue;
    const EyeGeometry& g = *eye.geometry;
    const EyePose pose(g, X_CM);
    const float distance = pose.p_ME.norm();
    if (eye.scores->has_color()) {
      int in = 0, in_sum = 0, out = 0, out_sum = 0;
      for (std::size_t i = 0; i < vertices_.size(); i += static_cast<std::size_t>(stride)) {
        const Vertex& v = vertices_[i];
        const float away = v.n_dot_p - v.n.dot(pose.p_ME);  // < 0: turned to the eye
        if (away >= 0) continue;
        if (v.inside) {
          const PixelOf at = Project(g, pose.InEye(v.p));
          const PackedScores s = eye.scores->At(at.u, at.v);
          in_sum += std::clamp(v.hair ? HairScore(s) : SkinScore(s), -kScoreLimit, kScoreLimit);
          ++in;
        }
        if (v.outline && away > -kGrazing * distance) {
          for (const float beyond : {0.010f, 0.022f}) {
            const PixelOf at = Project(g, pose.InEye(v.p + beyond * v.n));
            out_sum += std::clamp(HeadScore(eye.scores->At(at.u, at.v)), -kScoreLimit, kScoreLimit);
            ++out;
          }
        }
      }
      score.inside += static_cast<double>(in_sum) / (kScoreUnit * std::max(in, 1));
      score.outside += static_cast<double>(out_sum) / (kScoreUnit * std::max(out, 1));
      ++color_eyes;
    }
    int n = 0;
    float x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < face_.size(); i += static_cast<std::size_t>(stride)) {
      if (!usable[i]) continue;
      const Vector3f& p = face_.points[i];
      if (face_.normals[i].dot(p - pose.p_ME) > -0.2f * distance) continue;
      const PixelOf at = Project(g, pose.InEye(p));
      float value;
      if (!eye.bands->Nearest(kCoarseBand, at.u, at.v, &value)) continue;
      const float t = pattern[i];
      x += t;
      y += value;
      xx += t * t;
      xy += t * value;
      yy += value * value;
      ++n;
    }
    ++ncc_eyes;
    if (n < kFewestPattern) continue;
    const float in = 1 / static_cast<float>(n);
    const float cov = xy - x * y * in, vx = xx - x * x * in, vy = yy - y * y * in;
    score.ncc += static_cast<double>(cov / std::sqrt(vx * vy + 1e-6f));
  }
  if (color_eyes > 0) {
    score.inside /= color_eyes;
    score.outside /= color_eyes;
  }
  if (ncc_eyes > 0) score.ncc /= ncc_eyes;
  score.has_color = color_eyes > 0;
  score.has_ncc = ncc_eyes > 0;
  return score;
}

}  // namespace visavis
