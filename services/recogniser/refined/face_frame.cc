#include "services/recogniser/refined/face_frame.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "services/recogniser/refined/pose_equations.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kLevel = 5;
constexpr double kGenericSpacing_m = 0.003;
constexpr float kBeyondCone = 0.15f;  ///< cosine; wider than kNear_m on any head
constexpr float kSmooth_m = 0.003f, kNear_m = 0.008f, kLeastWeight = 0.3f;

/// One kind of evidence: what a point may be off, beyond how many times that it hardly counts more,
/// and how much a point is worth, as its neighbours see the same noise.
struct Kind {
  double sigma, limit, weight;

  double Misfit(double off) const {
    const double misfit = off / sigma;
    return weight * misfit / std::sqrt(1 + misfit * misfit / (limit * limit));
  }
};
constexpr Kind kMirrorLooks{0.5, 2, 0.3};       ///< of the face's contrast
constexpr Kind kMirrorShape{0.001, 3, 0.1};     ///< [m]
constexpr Kind kFeatures{1, 2, 0.1};            ///< of the face's contrast
constexpr Kind kGenericShape{0.001, 10, 0.02};  ///< [m]
constexpr double kOrigin_m = 0.001;             ///< the outlines have told it

constexpr double kLeastInformation = 1e-3;  ///< [1/rad^2]
constexpr int kMostSteps = 12, kPerPoint = 4;
constexpr double kMoved_m = 5e-5, kTurned_rad = 5e-4;  ///< steps so small change nothing
constexpr double kProbe_m = 5e-4, kProbe_rad = 6e-3;   ///< of the numeric derivative

float Mean(const std::vector<float>& by_vertex, const Icosphere::Place& place) {
  float sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum +=
        place.weights[static_cast<int>(i)] * by_vertex[static_cast<std::size_t>(place.corners[i])];
  }
  return sum;
}

}  // namespace

FaceFrame::FaceFrame(const HeadSurface& generic)
    : sphere_(kLevel), generic_radii_(RadiiOf(generic)) {
  const FacePoints dense = FacePointsOf(generic, kGenericSpacing_m);
  std::vector<Vector3f> points;
  std::array<std::vector<float>, kNumBands> values;
  for (std::size_t i = 0; i < dense.size(); ++i) {
    if (!dense.has_generic[i]) continue;
    points.push_back(dense.points[i]);
    for (const Band band : {kCoarseBand, kFineBand}) values[band].push_back(dense.generic[band][i]);
  }
  generic_looks_ = LooksOf(points, values);
}

std::array<FaceFrame::Looks, kNumBands> FaceFrame::LooksOf(
    const std::vector<Vector3f>& points,
    const std::array<std::vector<float>, kNumBands>& value) const {
  const std::vector<Vector3f>& directions = sphere_.vertices();
  std::array<Looks, kNumBands> looks;
  for (Looks& l : looks) {
    l.value.assign(directions.size(), 0);
    l.known.assign(directions.size(), 0);
  }
  Vector3f middle = Vector3f::Zero();
  for (const Vector3f& p : points) middle += p.normalized();
  middle.normalize();
  float widest = 1;  // cosine of the angle from there that holds them all
  for (const Vector3f& p : points) widest = std::min(widest, middle.dot(p.normalized()));
  for (std::size_t v = 0; v < directions.size(); ++v) {
    if (middle.dot(directions[v]) < widest - kBeyondCone) continue;
    std::array<float, kNumBands> sums{};
    float weights = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float along = points[i].dot(directions[v]);
      const float aside = points[i].squaredNorm() - along * along;
      if (along < 0 || aside > kNear_m * kNear_m) continue;
      const float weight = std::exp(-aside / (2 * kSmooth_m * kSmooth_m));
      for (std::size_t band = 0; band < kNumBands; ++band) sums[band] += weight * value[band][i];
      weights += weight;
    }
    if (weights <= kLeastWeight) continue;
    for (std::size_t band = 0; band < kNumBands; ++band) {
      looks[band].known[v] = 1;
      looks[band].value[v] = sums[band] / weights;
    }
  }
  return looks;
}

std::vector<float> FaceFrame::RadiiOf(const HeadSurface& surface) const {
  std::vector<float> radii;
  radii.reserve(sphere_.vertices().size());
  for (const Vector3f& direction : sphere_.vertices()) radii.push_back(surface.Radius(direction));
  return radii;
}

void FaceFrame::Misfits(Asked* asked, const RigidTransform& X_MN, Eigen::VectorXd* misfits) const {
  auto& [points, value, radii, generic, looks, contrast, triangles] = *asked;
  misfits->setZero(static_cast<Eigen::Index>(points.size()) * kPerPoint);
  const Eigen::Isometry3f X(X_MN.matrix().cast<float>()), X_back = X.inverse();
  std::vector<std::pair<std::size_t, float>> features;  // points where the generic face says one
  for (std::size_t i = 0; i < points.size(); ++i) {
    double* const out = misfits->data() + static_cast<std::ptrdiff_t>(i) * kPerPoint;
    const Vector3f p_M = X * points[i];
    const Vector3f mirrored = X_back * Vector3f(-p_M.x(), p_M.y(), p_M.z());
    const Icosphere::Place other_side = sphere_.LocateNear(mirrored, &triangles[i][0]);
    const float beyond = mirrored.norm() - Mean(radii, other_side);
    out[0] = kMirrorShape.Misfit(static_cast<double>(beyond));
    if (looks.Knows(other_side)) {
      const float other = Mean(looks.value, other_side);
      out[1] = kMirrorLooks.Misfit(static_cast<double>(other - value[i]) / contrast);
    }
    const Icosphere::Place place = sphere_.LocateNear(p_M, &triangles[i][1]);
    const float over = p_M.norm() - Mean(generic_radii_, place);
    out[2] = kGenericShape.Misfit(static_cast<double>(over));
    if (generic.Knows(place)) features.emplace_back(i, Mean(generic.value, place));
  }
  // value = gain * feature + offset
  double n = 0, f = 0, v = 0, ff = 0, fv = 0;
  for (const auto& [i, feature_f] : features) {
    const double feature = static_cast<double>(feature_f), seen = static_cast<double>(value[i]);
    n += 1;
    f += feature;
    v += seen;
    ff += feature * feature;
    fv += feature * seen;
  }
  const double gain = (n * fv - f * v) / std::max(n * ff - f * f, 1e-12);
  const double offset = (v - gain * f) / std::max(n, 1.0);
  for (const auto& [i, feature] : features) {
    const double expected = gain * static_cast<double>(feature) + offset;
    (*misfits)[static_cast<Eigen::Index>(i) * kPerPoint + 3] =
        kFeatures.Misfit((static_cast<double>(value[i]) - expected) / contrast);
  }
}

RigidTransform FaceFrame::Refine(Asked* asked, const RigidTransform& X_start,
                                 const Eigen::Vector3d& p_NM) const {
  RigidTransform X_MN = X_start;
  Eigen::VectorXd now, more, less;
  for (int k = 0; k < kMostSteps; ++k) {
    Misfits(asked, X_MN, &now);
    Eigen::MatrixXd J(now.size(), 6);
    for (int i = 0; i < 6; ++i) {
      Vector6d probe = Vector6d::Zero();
      probe[i] = i < 3 ? kProbe_m : kProbe_rad;
      Misfits(asked, Moved(X_MN, probe), &more);
      Misfits(asked, Moved(X_MN, -probe), &less);
      J.col(i) = (more - less) / (2 * probe[i]);
    }
    Matrix6d H = J.transpose() * J;
    Vector6d g = -J.transpose() * now;
    // The outlines' origin is M's.
    H.diagonal().head<3>().array() += 1 / (kOrigin_m * kOrigin_m);
    g.head<3>() -= X_MN * p_NM / (kOrigin_m * kOrigin_m);
    H.diagonal().tail<3>().array() += kLeastInformation;
    const Vector6d step = H.ldlt().solve(g);
    if (!step.allFinite()) break;
    X_MN = Moved(X_MN, step);
    if (step.head<3>().norm() < kMoved_m && step.tail<3>().norm() < kTurned_rad) break;
  }
  return X_MN;
}

// Coarse looks lead from farther away, fine ones are exact.
RigidTransform FaceFrame::Find(const LearnedFace& face, const HeadSurface& surface,
                               const Eigen::Vector3d& p_NM) const {
  RigidTransform X_MN = MakeTransform(Eigen::Matrix3d::Identity(), -p_NM);
  const std::array<Looks, kNumBands> looks = LooksOf(face.points, face.value);
  const std::vector<float> radii = RadiiOf(surface);
  for (const Band band : {kCoarseBand, kFineBand}) {
    const std::vector<float>& value = face.value[band];
    double sum = 0;
    for (const float v : value) sum += static_cast<double>(v * v);
    if (!(sum > 0)) continue;
    Asked asked{face.points,
                value,
                radii,
                generic_looks_[band],
                looks[band],
                std::sqrt(sum / static_cast<double>(value.size())),
                std::vector<std::array<std::size_t, 2>>(value.size())};
    X_MN = Refine(&asked, X_MN, p_NM);
  }
  return X_MN;
}

}  // namespace visavis
