#include "services/recogniser/refined/mesh_fitness.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/core/check.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr double kScoreUnit = 40;  ///< 2 nats
constexpr float kGrazing = 0.22f;  ///< cosine below which a vertex lies at the outline
constexpr float kPatternFacing = 0.2f;
constexpr float kFar = 1e9f;  ///< [m]
constexpr ScoreRings kSurface{1, {0, 0}}, kRound{2, {0.010f, 0.022f}};
constexpr double kOneEyeMargin = 0.3;
constexpr double kNccWeight = 1.5;
constexpr float kLargestPattern = 127;
constexpr int kHairShift = 0, kSkinShift = 8, kHeadShift = 16;

double Mean(const ScoreSum& s) { return s.sum / (kScoreUnit * std::max(s.count, 1)); }

/// Indices in an order that keeps neighbours together, so that blocks of points turn away together.
void SortByDirection(const std::vector<Vector3f>& normals, std::vector<std::size_t>::iterator begin,
                     std::vector<std::size_t>::iterator end) {
  if (end - begin <= kLanes) return;
  Vector3f low = normals[*begin], high = low;
  for (auto it = begin; it != end; ++it) {
    low = low.cwiseMin(normals[*it]);
    high = high.cwiseMax(normals[*it]);
  }
  Eigen::Index axis;
  (high - low).maxCoeff(&axis);
  const auto middle = begin + PaddedSize(static_cast<int>(end - begin) / 2);
  std::nth_element(begin, middle, end, [&](std::size_t a, std::size_t b) {
    return std::pair(normals[a][axis], a) < std::pair(normals[b][axis], b);
  });
  SortByDirection(normals, begin, middle);
  SortByDirection(normals, middle, end);
}

}  // namespace

double MeshScore::total() const {
  return 0.5 * (inside - std::max(outside, -1.0)) + (has_ncc ? kNccWeight * ncc : 0);
}

MeshFitness::MeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail) {
  const auto step = static_cast<std::size_t>(detail);
  std::vector<std::size_t> inside, outline;
  std::size_t num_inside = 0, num_outline = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (mesh.coloured[i] && num_inside++ % (2 * step) == 0) inside.push_back(i);
    if (mesh.contour_weights[i] > 0 && num_outline++ % step == 0) outline.push_back(i);
  }
  SortByDirection(mesh.normals, inside.begin(), inside.end());
  SortByDirection(mesh.normals, outline.begin(), outline.end());
  for (const std::size_t i : inside) {
    inside_.Add(mesh.vertices[i], mesh.normals[i], mesh.normals[i].dot(mesh.vertices[i]),
                mesh.parts[i] == HeadPart::kHair ? kHairShift : kSkinShift);
  }
  for (const std::size_t i : outline) {
    outside_.Add(mesh.vertices[i], mesh.normals[i], mesh.normals[i].dot(mesh.vertices[i]),
                 kHeadShift);
  }
  AddPattern(face, 2 * step);
  for (ScorePoints* points : {&inside_, &outside_}) points->Pad();
}

void MeshFitness::AddPattern(const FacePoints& face, std::size_t step) {
  const std::vector<float>& generic = face.generic[kCoarseBand];
  float largest = 1e-6f;
  for (const float value : generic) largest = std::max(largest, std::abs(value));
  std::size_t count = 0;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!face.has_generic[i] || count++ % step != 0) continue;
    pattern_.Add(face.points[i], face.normals[i], face.normals[i].dot(face.points[i]),
                 static_cast<int>(std::lround(kLargestPattern / largest * generic[i])));
  }
  VISAVIS_THROW_UNLESS(pattern_.size() <= kMostPatternPoints, pattern_.size());
  pattern_.Pad();
}

MeshFitness::Poses MeshFitness::PosesOf(const StereoView& view, const RigidTransform& X_CM) {
  const auto pose = [&](const EyeView& eye) {
    return KernelEye(*eye.geometry, EyePose(*eye.geometry, X_CM));
  };
  return {pose(view[0]), pose(view[1])};
}

void MeshFitness::AddCorrelation(const StereoView& view, const Poses& poses,
                                 MeshScore* score) const {
  int eyes = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!view[e].seen()) continue;
    const PatternSums sums = SumPattern(poses[e], view[e].bands->view(kCoarseBand), pattern_,
                                        -kPatternFacing * poses[e].distance);
    score->ncc += sums.correlation();
    ++eyes;
  }
  score->has_ncc = eyes > 0;
  score->ncc /= std::max(eyes, 1);
}

void MeshFitness::AddAgreement(const StereoView& view, const Poses& poses, MeshScore* score) const {
  if (!view[0].seen() || !view[1].seen()) return;
  const BandView bands[] = {view[0].bands->view(kCoarseBand), view[1].bands->view(kCoarseBand)};
  const float highest[] = {-kPatternFacing * poses[0].distance,
                           -kPatternFacing * poses[1].distance};
  score->agreement = SumAgreement(poses.data(), bands, pattern_, highest).correlation();
}

void MeshFitness::AddInside(const StereoView& view, const Poses& poses, MeshScore* score) const {
  int eyes = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!view[e].seen()) continue;
    score->inside += Mean(SumScores(poses[e], view[e].scores->view(), inside_, kSurface, -kFar));
    ++eyes;
  }
  score->inside /= std::max(eyes, 1);
}

void MeshFitness::AddOutside(const StereoView& view, const Poses& poses, MeshScore* score) const {
  int eyes = 0;
  for (std::size_t e = 0; e < 2; ++e) {
    if (!view[e].seen()) continue;
    const ScoreSum sum = SumScores(poses[e], view[e].scores->view(), outside_, kRound,
                                   -kGrazing * poses[e].distance);
    score->outside += Mean(sum);
    ++eyes;
  }
  score->outside /= std::max(eyes, 1);
}

MeshScore MeshFitness::Evaluate(const StereoView& view, const RigidTransform& X_CM) const {
  for (const EyeView& eye : view) VISAVIS_THROW_UNLESS(eye.scores || !eye.seen(), eye.seen());
  MeshScore score;
  const Poses poses = PosesOf(view, X_CM);
  AddCorrelation(view, poses, &score);
  AddInside(view, poses, &score);
  AddOutside(view, poses, &score);
  return score;
}

MeshScore MeshFitness::Look(const StereoView& view, const RigidTransform& X_CM) const {
  MeshScore score = Evaluate(view, X_CM);
  AddAgreement(view, PosesOf(view, X_CM), &score);
  return score;
}

double MeshFitness::FoundIfWorth(const StereoView& view, const RigidTransform& X_CM,
                                 double worth) const {
  if (!view[0].seen() || !view[1].seen()) return Look(view, X_CM).found();
  StereoView one = view;
  one[1].Close();
  MeshScore right = Evaluate(one, X_CM);
  const double least = worth - kOneEyeMargin;
  if (right.total() + MeshScore::kAgreementWeight < least) return right.total();
  AddAgreement(view, PosesOf(view, X_CM), &right);
  if (right.found() < least) return right.found();
  one = view;
  one[0].Close();
  const MeshScore left = Evaluate(one, X_CM);
  MeshScore both = right;
  both.inside = 0.5 * (right.inside + left.inside);
  both.outside = 0.5 * (right.outside + left.outside);
  both.ncc = 0.5 * (right.ncc + left.ncc);
  return both.found();
}

}  // namespace visavis
