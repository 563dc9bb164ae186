#include "services/recogniser/refined/contour_term.h"

#include <algorithm>

#include "common/core/check.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kMargin = 1e-5f;  ///< [m] of rounding
constexpr int kHairlineReach = 7;
constexpr float kHairlineFacing = 0.35f;

}  // namespace

ContourTerm::ContourTerm(const HeadMesh& mesh, const Hairline& hairline)
    : mesh_(mesh),
      hairline_(hairline),
      likelihoods_(ContourLikelihoods()),
      silhouette_(kDirections) {
  VISAVIS_THROW_UNLESS(static_cast<int>(hairline.points.size()) <= ContourPoints::kSize,
                       hairline.points.size());
  const std::size_t n = mesh.vertices.size();
  const auto padded = static_cast<std::size_t>(PaddedSize(static_cast<int>(n)));
  for (auto* column : {&vertices_.normal_x, &vertices_.normal_y, &vertices_.normal_z,
                       &vertices_.n_dot_p, &vertices_.reach_a_m, &facing_}) {
    column->resize(padded);
  }
  vertices_.reach.resize(padded, -1);
  near_.resize(padded + kLanes);
  for (std::size_t i = 0; i < n; ++i) {
    vertices_.normal_x[i] = mesh.normals[i].x();
    vertices_.normal_y[i] = mesh.normals[i].y();
    vertices_.normal_z[i] = mesh.normals[i].z();
    vertices_.n_dot_p[i] = mesh.normals[i].dot(mesh.vertices[i]);
  }
  auto edges = mesh.edges;
  for (auto& edge : edges) std::sort(edge.begin(), edge.end());
  std::sort(edges.begin(), edges.end());
  first_edge_.resize(n + 1);
  for (const auto& [ia, ib] : edges) {
    const auto a = static_cast<std::size_t>(ia), b = static_cast<std::size_t>(ib);
    ++first_edge_[a + 1];
    edge_ends_.push_back(ib);
    vertices_.reach[a] = std::max(vertices_.reach[a],
                                  std::abs(vertices_.n_dot_p[a] - vertices_.n_dot_p[b]) + kMargin);
    vertices_.reach_a_m[a] =
        std::max(vertices_.reach_a_m[a], (mesh.normals[a] - mesh.normals[b]).norm());
  }
  for (std::size_t i = 0; i < n; ++i) first_edge_[i + 1] += first_edge_[i];
}

// Where a mesh edge passes from turned to the eye to turned away; of those in about one direction
// from the head's middle the outermost, which no other hides.
void ContourTerm::FindSilhouette(const KernelEye& eye, const EyePose& pose) {
  for (Candidate& c : silhouette_) c.distance = -1;
  const Vector3f middle = pose.InEye({0, 0.008f, 0});
  const float middle_uv[2] = {middle.x() / middle.z(), middle.y() / middle.z()};
  const auto flush = [&] {
    ReadEnds();
    PlaceCrossings(eye, middle_uv, kDirections, &crossings_);
    KeepOutermost();
    crossings_.n = 0;
  };
  const int num_near = FindNearOutline(eye, vertices_, facing_.data(), near_.data());
  Crossings& c = crossings_;
  c.n = 0;
  for (int k = 0; k < num_near; ++k) {
    const std::int32_t a = near_[static_cast<std::size_t>(k)];
    const float facing_a = facing_[static_cast<std::size_t>(a)];
    for (std::int32_t e = first_edge_[static_cast<std::size_t>(a)];
         e < first_edge_[static_cast<std::size_t>(a) + 1]; ++e) {
      // Which edges cross is hard to predict: all are written, those that do are kept.
      const std::int32_t b = edge_ends_[static_cast<std::size_t>(e)];
      const auto i = static_cast<std::size_t>(c.n);
      c.a[i] = a;
      c.b[i] = b;
      c.n += (facing_a < 0) != (facing_[static_cast<std::size_t>(b)] < 0);
      if (c.n == Crossings::kSize) flush();
    }
  }
  flush();
}

void ContourTerm::ReadEnds() {
  Crossings& c = crossings_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.n); ++i) {
    const auto a = static_cast<std::size_t>(c.a[i]), b = static_cast<std::size_t>(c.b[i]);
    const Vector3f &p = mesh_.vertices[a], &q = mesh_.vertices[b];
    c.ax[i] = p.x();
    c.ay[i] = p.y();
    c.az[i] = p.z();
    c.bx[i] = q.x();
    c.by[i] = q.y();
    c.bz[i] = q.z();
    c.facing_a[i] = facing_[a];
    c.facing_b[i] = facing_[b];
  }
}

void ContourTerm::KeepOutermost() {
  const Crossings& c = crossings_;
  for (std::size_t i = 0; i < static_cast<std::size_t>(c.n); ++i) {
    Candidate& kept = silhouette_[static_cast<std::size_t>(c.bin[i])];
    if (c.distance[i] <= kept.distance) continue;
    kept = {{c.x[i], c.y[i], c.z[i]},
            c.distance[i],
            c.facing_a[i] / (c.facing_a[i] - c.facing_b[i]),
            c.a[i],
            c.b[i]};
  }
}

void ContourTerm::Measure(const EyeView& eye, const KernelEye& kernel_eye, int reach,
                          PoseEquations* equations, ContourFit* fit) {
  VISAVIS_THROW_UNLESS(eye.scores != nullptr, reach);
  points_.Pad();
  MeasureContours(kernel_eye, eye.scores->view(), points_, reach, likelihoods_, &rows_);
  EquationSums sums;
  sums.Add(rows_);
  sums.AddTo(equations);
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows_.n); ++i) {
    if (!(rows_.weight[i] > 0)) continue;
    fit->count += 1;
    fit->sum_square += std::min(25.0f, rows_.residual[i] * rows_.residual[i]);
  }
}

void ContourTerm::Add(const EyeView& eye, const EyePose& pose, int reach_px, float outline_weight,
                      float hairline_weight, PoseEquations* equations, ContourFit* fit) {
  const int reach = std::clamp(reach_px, 2, kMaxContourReach);
  const KernelEye kernel_eye(*eye.geometry, pose);
  FindSilhouette(kernel_eye, pose);
  points_.n = 0;
  for (const Candidate& c : silhouette_) {
    if (c.distance < 0) continue;
    const auto a = static_cast<std::size_t>(c.a), b = static_cast<std::size_t>(c.b);
    const HeadPart part_a = mesh_.parts[a], part_b = mesh_.parts[b];
    const float weight = mesh_.contour_weights[a] * mesh_.contour_weights[b];
    const bool one_part = (part_a == HeadPart::kHair) == (part_b == HeadPart::kHair);
    if (!one_part || weight <= 0) continue;
    points_.Add(c.p_M, (1 - c.t) * mesh_.normals[a] + c.t * mesh_.normals[b],
                part_a == HeadPart::kHair ? Edge::kHair : Edge::kSkin, outline_weight * weight);
  }
  Measure(eye, kernel_eye, reach, equations, fit);
  if (hairline_weight <= 0) return;
  ContourFit ignored;
  points_.n = 0;
  for (std::size_t i = 0; i < hairline_.points.size(); ++i) {
    const Vector3f& p = hairline_.points[i];
    const Vector3f view = p - pose.p_ME;
    if (p.dot(view) > -kHairlineFacing * p.norm() * view.norm()) continue;
    // Inside is hair here: its outward side is down on the face.
    points_.Add(p, -hairline_.into_hair[i], Edge::kHairline, hairline_weight);
  }
  Measure(eye, kernel_eye, std::min(reach, kHairlineReach), equations, &ignored);
}

const std::vector<OutlineMeasurement>& ContourTerm::MeasureOutline(const EyeView& eye,
                                                                   const EyePose& pose,
                                                                   int reach_px) {
  PoseEquations ignored;
  ContourFit ignored_too;
  rows_.n = 0;
  Add(eye, pose, reach_px, 1, 0, &ignored, &ignored_too);
  outline_.clear();
  for (std::size_t i = 0; i < static_cast<std::size_t>(rows_.n); ++i) {
    if (!(rows_.weight[i] > 0)) continue;
    outline_.push_back({{points_.x[i], points_.y[i], points_.z[i]},
                        {rows_.slope_x[i], rows_.slope_y[i], rows_.slope_z[i]},
                        rows_.residual[i],
                        rows_.weight[i]});
  }
  return outline_;
}

}  // namespace visavis
