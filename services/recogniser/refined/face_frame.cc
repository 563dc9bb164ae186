#include "services/recogniser/refined/face_frame.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/pose_equations.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kLevel = 5;
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
constexpr Kind kMirrorLooks{0.5, 2, 0.3};    ///< of the face's contrast
constexpr Kind kMirrorShape{0.001, 3, 0.1};  ///< [m]
constexpr Kind kShape{0.0015, 3, 0.25};      ///< [m] that the modes leave
constexpr Kind kLooks{1, 2, 0.35};           ///< of what is known of a place

constexpr double kLeastInformation = 1e-3;  ///< [1/rad^2]
constexpr int kPerPoint = 4, kMostSteps = 12, kFewSteps = 3;
constexpr std::size_t kBestStarts = 3;
constexpr std::size_t kFewPoints = 3;  ///< of so many points one is asked about the starts
constexpr double kFewestPoints = 100;  ///< that looks are fitted to
constexpr double kMoved_m = 5e-5, kTurned_rad = 5e-4;  ///< steps so small change nothing
constexpr double kProbe_m = 5e-4, kProbe_rad = 6e-3;   ///< of the numeric derivative
constexpr double kStartY_m = 0.010, kStartNod_rad = 0.13, kStartYaw_rad = 0.07;
constexpr int kStartsY = 3, kStartsNod = 2, kStartsYaw = 1;  ///< to either side

float Mean(const std::vector<float>& by_vertex, const Icosphere::Place& place) {
  float sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum +=
        place.weights[static_cast<int>(i)] * by_vertex[static_cast<std::size_t>(place.corners[i])];
  }
  return sum;
}

/// The linear parameters x, a priori of variance 1, that make A x closest to b.
Eigen::VectorXd Solve(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
  Eigen::MatrixXd H = A.transpose() * A;
  H.diagonal().array() += 1;
  return H.ldlt().solve(A.transpose() * b);
}

}  // namespace

FaceFrame::FaceFrame(const AdultHead& adult)
    : adult_(adult),
      sphere_(kLevel),
      shape_sphere_(Icosphere::LevelOf(static_cast<std::size_t>(adult.shape_modes_m.rows()))),
      adult_radii_m_([&] {
        Eigen::VectorXd radii(adult.shape_modes_m.rows());
        for (Eigen::Index i = 0; i < radii.size(); ++i) {
          radii[i] = static_cast<double>(
              adult.surface.Radius(shape_sphere_.vertices()[static_cast<std::size_t>(i)]));
        }
        return radii;
      }()) {}

FaceFrame::Looks FaceFrame::LooksOf(const std::vector<Vector3f>& points,
                                    const std::vector<float>& value) const {
  const std::vector<Vector3f>& directions = sphere_.vertices();
  Looks looks;
  looks.value.assign(directions.size(), 0);
  looks.known.assign(directions.size(), 0);
  Vector3f middle = Vector3f::Zero();
  for (const Vector3f& p : points) middle += p.normalized();
  middle.normalize();
  float widest = 1;  // cosine of the angle from there that holds them all
  for (const Vector3f& p : points) widest = std::min(widest, middle.dot(p.normalized()));
  for (std::size_t v = 0; v < directions.size(); ++v) {
    if (middle.dot(directions[v]) < widest - kBeyondCone) continue;
    float sum = 0, weights = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float along = points[i].dot(directions[v]);
      const float aside = points[i].squaredNorm() - along * along;
      if (along < 0 || aside > kNear_m * kNear_m) continue;
      const float weight = std::exp(-aside / (2 * kSmooth_m * kSmooth_m));
      sum += weight * value[i];
      weights += weight;
    }
    if (weights <= kLeastWeight) continue;
    looks.known[v] = 1;
    looks.value[v] = sum / weights;
  }
  return looks;
}

std::vector<float> FaceFrame::RadiiOf(const HeadSurface& surface) const {
  std::vector<float> radii;
  radii.reserve(sphere_.vertices().size());
  for (const Vector3f& direction : sphere_.vertices()) radii.push_back(surface.Radius(direction));
  return radii;
}

void FaceFrame::AddMirrored(Asked* asked, const RigidTransform& X_MN, double* misfits) const {
  auto& [points, value, weight, radii, looks, contrast, triangles] = *asked;
  const Eigen::Isometry3f X(X_MN.matrix().cast<float>()), X_back = X.inverse();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3f p_M = X * points[i];
    const Vector3f mirrored = X_back * Vector3f(-p_M.x(), p_M.y(), p_M.z());
    const Icosphere::Place other_side = sphere_.LocateNear(mirrored, &triangles[i][0]);
    const float beyond = mirrored.norm() - Mean(radii, other_side);
    misfits[2 * i] = weight * kMirrorShape.Misfit(static_cast<double>(beyond));
    if (!looks.Knows(other_side)) continue;
    const float other = Mean(looks.value, other_side);
    misfits[2 * i + 1] =
        weight * kMirrorLooks.Misfit(static_cast<double>(other - value[i]) / contrast);
  }
}

double FaceFrame::AddLooks(const Asked& asked, const RigidTransform& X_MN, double* misfits) const {
  constexpr int kModes = AdultLooks::kModes;
  constexpr double kLeastGain = AdultLooks::kLeastGain;
  constexpr double kIndependence = AdultLooks::kIndependence;
  const Eigen::Isometry3f X(X_MN.matrix().cast<float>());
  const auto size = static_cast<Eigen::Index>(asked.points.size());
  Eigen::MatrixXd modes(size, kModes);
  Eigen::VectorXd mean(size), value(size), weight(size);
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < asked.points.size(); ++i) {
    const Vector3f p = X * asked.points[i];
    if (p.z() > -0.03f) continue;
    const AdultLooks::Place place = adult_.looks.At(p.x(), p.y());
    if (!place.known) continue;
    mean[n] = static_cast<double>(place.mean[kFineBand]);
    value[n] = static_cast<double>(asked.value[i]);
    weight[n] = static_cast<double>(AdultLooks::Weight(place.doubt));
    for (int k = 0; k < kModes; ++k)
      modes(n, k) = static_cast<double>(place.modes[static_cast<std::size_t>(k)]);
    ++n;
  }
  if (static_cast<double>(n) * asked.weight * asked.weight < kFewestPoints) {
    for (Eigen::Index i = 0; i < size; ++i)
      misfits[i] = asked.weight * kLooks.weight * kLooks.limit;
    return 0;
  }
  Eigen::VectorXd a = Eigen::VectorXd::Zero(kModes), off(n);
  double likeness = 0;
  const Eigen::VectorXd w = weight.head(n), v = value.head(n);
  const double sum = w.sum(), y = w.dot(v) / sum;
  const double var_y = (w.array() * (v.array() - y).square()).sum();
  for (int round = 0; round < 3; ++round) {
    const Eigen::VectorXd pattern = mean.head(n) + modes.topRows(n) * a;
    const double x = w.dot(pattern) / sum;
    const double var_x = std::max((w.array() * (pattern.array() - x).square()).sum(), 1e-9);
    const double cov = (w.array() * (pattern.array() - x) * (v.array() - y)).sum();
    const double gain = std::max(cov / var_x, kLeastGain * std::sqrt(var_y / var_x));
    const Eigen::VectorXd seen = ((v.array() - y) / gain + x).matrix();
    off = seen - pattern;
    likeness = 1 - (w.dot(off.cwiseAbs2()) + a.squaredNorm() / kIndependence) * gain * gain / var_y;
    if (round == 2) break;
    const Eigen::VectorXd root =
        (w.array() / (1 + off.array().square() * w.array() / (kLooks.limit * kLooks.limit)))
            .sqrt() *
        (asked.weight * kLooks.weight);
    a = Solve(root.asDiagonal() * modes.topRows(n), root.cwiseProduct(seen - mean.head(n)));
  }
  for (Eigen::Index i = 0; i < n; ++i)
    misfits[i] = asked.weight * kLooks.Misfit(off[i] * std::sqrt(w[i]));
  for (Eigen::Index i = n; i < size; ++i)
    misfits[i] = asked.weight * kLooks.weight;  // nothing is seen there
  for (int k = 0; k < kModes; ++k) misfits[size + k] = a[k];
  return likeness;
}

void FaceFrame::AddShape(Asked* asked, const RigidTransform& X_MN, double* misfits) const {
  const Eigen::MatrixXd& all = adult_.shape_modes_m;
  const Eigen::Isometry3f X(X_MN.matrix().cast<float>());
  const auto size = static_cast<Eigen::Index>(asked->points.size());
  Eigen::MatrixXd modes(size, all.cols());
  Eigen::VectorXd beyond(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3f p = X * asked->points[k];
    const Icosphere::Place place = shape_sphere_.LocateNear(p, &asked->triangles[k][1]);
    modes.row(i).setZero();
    beyond[i] = static_cast<double>(p.norm());
    for (std::size_t c = 0; c < 3; ++c) {
      const auto share = static_cast<double>(place.weights[static_cast<int>(c)]);
      modes.row(i) += share * all.row(place.corners[c]);
      beyond[i] -= share * adult_radii_m_[place.corners[c]];
    }
  }
  const double unit = asked->weight * kShape.weight / kShape.sigma;
  Eigen::VectorXd c = Solve(unit * modes, unit * beyond);
  // Once more without what is far off.
  Eigen::VectorXd off = beyond - modes * c;
  const Eigen::VectorXd root =
      unit * (1 + (off.array() / (kShape.sigma * kShape.limit)).square()).sqrt().inverse();
  c = Solve(root.asDiagonal() * modes, root.cwiseProduct(beyond));
  off = beyond - modes * c;
  for (Eigen::Index i = 0; i < size; ++i) misfits[i] = asked->weight * kShape.Misfit(off[i]);
  for (Eigen::Index k = 0; k < all.cols(); ++k) misfits[size + k] = c[k];
}

void FaceFrame::Misfits(Asked* asked, const RigidTransform& X_MN, Eigen::VectorXd* misfits) const {
  const auto size = static_cast<Eigen::Index>(asked->points.size());
  misfits->setZero(kPerPoint * size + AdultLooks::kModes + adult_.shape_modes_m.cols());
  AddMirrored(asked, X_MN, misfits->data());
  AddLooks(*asked, X_MN, misfits->data() + 2 * size);
  AddShape(asked, X_MN, misfits->data() + 3 * size + AdultLooks::kModes);
}

RigidTransform FaceFrame::Refine(Asked* asked, const RigidTransform& X_start, int most_steps,
                                 double* badness) const {
  RigidTransform X_MN = X_start;
  Eigen::VectorXd now, more, less;
  for (int k = 0; k < most_steps; ++k) {
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
    const Vector6d g = -J.transpose() * now;
    H.diagonal().tail<3>().array() += kLeastInformation;
    H.diagonal().head<3>().array() += kLeastInformation;
    const Vector6d step = H.ldlt().solve(g);
    if (!step.allFinite()) break;
    X_MN = Moved(X_MN, step);
    if (step.head<3>().norm() < kMoved_m && step.tail<3>().norm() < kTurned_rad) break;
  }
  Misfits(asked, X_MN, &now);
  *badness = now.squaredNorm();
  return X_MN;
}

RigidTransform FaceFrame::BestOf(const std::vector<RigidTransform>& starts, Asked* few) const {
  struct Start {
    double badness;
    RigidTransform X_MN;
  };
  std::vector<Start> all;
  Eigen::VectorXd misfits;
  for (const RigidTransform& X_MN : starts) {
    Misfits(few, X_MN, &misfits);
    all.push_back({misfits.squaredNorm(), X_MN});
  }
  const auto is_better = [](const Start& a, const Start& b) { return a.badness < b.badness; };
  std::sort(all.begin(), all.end(), is_better);
  all.resize(std::min(all.size(), kBestStarts));
  for (Start& start : all) start.X_MN = Refine(few, start.X_MN, kFewSteps, &start.badness);
  return std::min_element(all.begin(), all.end(), is_better)->X_MN;
}

FaceFrame::Found FaceFrame::FindFrom(const std::vector<RigidTransform>& starts,
                                     const LearnedFace& face, const HeadSurface& surface) const {
  const std::vector<float>& value = face.value[kFineBand];
  double sum = 0;
  for (const float v : value) sum += static_cast<double>(v * v);
  if (!(sum > 0)) return {RigidTransform::Identity(), 0};
  const Looks looks = LooksOf(face.points, value);
  const std::vector<float> radii = RadiiOf(surface);
  const double contrast = std::sqrt(sum / static_cast<double>(value.size()));
  const auto ask = [&](std::size_t every) {
    Asked asked{{}, {}, std::sqrt(static_cast<double>(every)), radii, looks, contrast, {}};
    for (std::size_t i = 0; i < value.size(); i += every) {
      asked.points.push_back(face.points[i]);
      asked.value.push_back(value[i]);
    }
    asked.triangles.resize(asked.points.size());
    return asked;
  };
  RigidTransform X_start = starts.front();
  if (starts.size() > 1) {
    Asked few = ask(kFewPoints);
    X_start = BestOf(starts, &few);
  }
  Asked all = ask(1);
  Eigen::VectorXd misfits;
  Misfits(&all, X_start, &misfits);
  const double start_badness = misfits.squaredNorm();
  double badness = 0;
  Found found;
  found.X_MN = Refine(&all, X_start, kMostSteps, &badness);
  if (!(badness <= start_badness)) found.X_MN = X_start;
  misfits.setZero(static_cast<Eigen::Index>(value.size()) + AdultLooks::kModes);
  found.likeness = AddLooks(all, found.X_MN, misfits.data());
  return found;
}

FaceFrame::Found FaceFrame::Find(const LearnedFace& face, const HeadSurface& surface) const {
  std::vector<RigidTransform> starts;
  for (int i = -kStartsY; i <= kStartsY; ++i) {
    for (int j = -kStartsNod; j <= kStartsNod; ++j) {
      for (int k = -kStartsYaw; k <= kStartsYaw; ++k) {
        starts.push_back(
            MakeTransform(RotationFromAngles({0, kStartYaw_rad * k, kStartNod_rad * j}),
                          Eigen::Vector3d(0, kStartY_m * i, 0)));
      }
    }
  }
  return FindFrom(starts, face, surface);
}

FaceFrame::Found FaceFrame::FindNear(const LearnedFace& face, const HeadSurface& surface) const {
  return FindFrom({RigidTransform::Identity()}, face, surface);
}

}  // namespace visavis
