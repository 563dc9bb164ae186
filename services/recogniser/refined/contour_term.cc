#include "services/recogniser/refined/contour_term.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kScoreLimit = 40;       ///< of one pixel: none decides alone
constexpr float kIndependence = 0.48f;  ///< neighbouring pixels are not independent witnesses
constexpr float kMinVariance = 0.5f;    ///< [px^2]
constexpr float kVagueShare = 0.28f;    ///< of reach^2: a posterior as wide says nothing
constexpr float kRobust_px2 = 9;

int ScoreOf(PackedScores s, int edge) {
  return edge == 0 ? HairScore(s) : edge == 1 ? SkinScore(s) : HairScore(s) - SkinScore(s);
}

}  // namespace

ContourTerm::ContourTerm(const HeadMesh& mesh, const Hairline& hairline)
    : mesh_(mesh), hairline_(hairline), facing_(mesh.vertices.size()), silhouette_(kDirections) {
  outline_.reserve(kDirections);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    n_dot_p_.push_back(mesh.normals[i].dot(mesh.vertices[i]));
  }
}

// Where a mesh edge passes from turned to the eye to turned away; of those in about one direction
// from the head's middle the outermost, which no other hides.
void ContourTerm::FindSilhouette(const EyePose& pose) {
  for (std::size_t i = 0; i < facing_.size(); ++i) {
    facing_[i] = n_dot_p_[i] - mesh_.normals[i].dot(pose.p_ME);
  }
  for (Candidate& c : silhouette_) c.distance = -1;
  const Vector3f middle = pose.InEye({0, 0.008f, 0});
  const float u0 = middle.x() / middle.z(), v0 = middle.y() / middle.z();
  for (const auto& [ia, ib] : mesh_.edges) {
    const auto a = static_cast<std::size_t>(ia), b = static_cast<std::size_t>(ib);
    if ((facing_[a] < 0) == (facing_[b] < 0)) continue;
    const float t = facing_[a] / (facing_[a] - facing_[b]);
    const Vector3f p = (1 - t) * mesh_.vertices[a] + t * mesh_.vertices[b];
    const Vector3f q = pose.InEye(p);
    const float du = q.x() / q.z() - u0, dv = q.y() / q.z() - v0;
    const float turn = std::atan2(dv, du) * static_cast<float>(0.5 / M_PI) + 0.5f;
    const int bin = std::clamp(static_cast<int>(turn * kDirections), 0, kDirections - 1);
    Candidate& c = silhouette_[static_cast<std::size_t>(bin)];
    const float distance = du * du + dv * dv;
    if (distance <= c.distance) continue;
    c.distance = distance;
    c.p_M = p;
    c.n_M = (1 - t) * mesh_.normals[a] + t * mesh_.normals[b];
    c.part = mesh_.parts[t < 0.5f ? a : b];
    const bool one_part =
        (mesh_.parts[a] == HeadPart::kHair) == (mesh_.parts[b] == HeadPart::kHair);
    c.weight = one_part ? mesh_.contour_weights[a] * mesh_.contour_weights[b] : 0;
  }
}

void ContourTerm::Measure(const EyeView& eye, const EyePose& pose, const Vector3f& p_M,
                          const Vector3f& n_M, Edge edge, int reach, float weight,
                          PoseEquations* equations, ContourFit* fit) {
  const EyeGeometry& g = *eye.geometry;
  const Vector3f p = pose.InEye(p_M), n = pose.R_EM * n_M;
  if (p.z() < 0.1f) return;
  const float iz = 1 / p.z(), x = p.x() * iz, y = p.y() * iz;
  const float u = g.cx + g.fx * x, v = g.cy + g.fy * y;
  float nu = g.fx * (n.x() - x * n.z()), nv = g.fy * (n.y() - y * n.z());
  const float length = std::sqrt(nu * nu + nv * nv);
  if (!(length > 1e-6f)) return;
  nu /= length;
  nv /= length;

  // cumulated[i]: the boundary lies between pixels i and i + 1 of the normal.
  std::array<float, 2 * kMaxReach + 1> cumulated;
  const int n_pixels = 2 * reach + 1;
  float sum = 0, best = -1e9f;
  for (int i = 0; i < n_pixels; ++i) {
    const auto s = static_cast<float>(i - reach);
    const PackedScores scores = eye.scores->At(u + s * nu, v + s * nv);
    if (!IsKnown(scores)) return;
    const float score = static_cast<float>(ScoreOf(scores, static_cast<int>(edge)));
    sum += std::clamp(score, -kScoreLimit, kScoreLimit) * (kIndependence / kScorePerNat);
    cumulated[static_cast<std::size_t>(i)] = sum;
    if (i < n_pixels - 1) best = std::max(best, sum);
  }
  float total = 0, first = 0, second = 0;
  for (int i = 0; i < n_pixels - 1; ++i) {
    const float probability = std::exp(cumulated[static_cast<std::size_t>(i)] - best);
    const float d = static_cast<float>(i - reach) + 0.5f;
    total += probability;
    first += probability * d;
    second += probability * d * d;
  }
  const float mean = first / total, variance = second / total - mean * mean;
  if (variance > kVagueShare * static_cast<float>(reach * reach)) return;
  fit->count += 1;
  fit->sum_square += std::min(25.0f, mean * mean);
  const Vector3f slope_E(nu * g.fx * iz, nv * g.fy * iz, -(nu * g.fx * x + nv * g.fy * y) * iz);
  if (edge != Edge::kHairline)
    outline_.push_back({p_M, g.R_EC.transpose() * slope_E, mean,
                        weight / (variance + kMinVariance) / (1 + mean * mean / kRobust_px2)});
  equations->Add(g.R_EC.transpose() * slope_E, pose.R_CM * p_M, mean,
                 weight / (variance + kMinVariance) / (1 + mean * mean / kRobust_px2));
}

void ContourTerm::Add(const EyeView& eye, const EyePose& pose, int reach_px, float outline_weight,
                      float hairline_weight, PoseEquations* equations, ContourFit* fit) {
  if (!eye.scores->has_color()) return;
  const int reach = std::clamp(reach_px, 2, kMaxReach);
  FindSilhouette(pose);
  outline_.clear();
  for (const Candidate& c : silhouette_) {
    if (c.distance < 0 || c.weight <= 0) continue;
    Measure(eye, pose, c.p_M, c.n_M, c.part == HeadPart::kHair ? Edge::kHair : Edge::kSkin, reach,
            outline_weight * c.weight, equations, fit);
  }
  if (hairline_weight <= 0) return;
  ContourFit ignored;
  for (std::size_t i = 0; i < hairline_.points.size(); ++i) {
    const Vector3f& p = hairline_.points[i];
    const Vector3f view = p - pose.p_ME;
    if (p.dot(view) > -0.35f * p.norm() * view.norm()) continue;
    // Inside is hair here: its outward side is down on the face.
    Measure(eye, pose, p, -hairline_.into_hair[i], Edge::kHairline, std::min(reach, 7),
            hairline_weight, equations, &ignored);
  }
}

}  // namespace visavis
