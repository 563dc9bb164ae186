#include "tests/people/head_alignment.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "services/recogniser/refined/icosphere.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::VectorXd;

constexpr int kLevel = 5, kRounds = 8, kSteps = 4;
constexpr double kRobust_m = 0.006;
constexpr double kDelta_m = 5e-4, kDelta_rad = 5e-3;  ///< of the numeric derivatives
constexpr int kFewest = 50;                           ///< directions
constexpr float kHalfBreadth_m = 0.050f, kTop_m = -0.015f, kBottom_m = 0.105f, kRear_m = -0.045f;

/// M moved by y, z [m] and turned about x [rad].
RigidTransform Moved(const Vector3d& by) {
  return MakeTransform(ExpRotation({by[2], 0, 0}), Vector3d(0, by[0], by[1]));
}

VectorXd RadiiOf(const RadiusFunction& head, const FaceRegion& face, const RigidTransform& X_TM) {
  VectorXd radii(static_cast<Eigen::Index>(face.directions.size()));
  for (Eigen::Index i = 0; i < radii.size(); ++i)
    radii[i] = static_cast<double>(head(X_TM, face.directions[static_cast<std::size_t>(i)]));
  return radii;
}

/// The mean of what the heads have; NaN where none has any.
VectorXd MeanRadii(const std::vector<HeadToAlign>& heads, const FaceRegion& face) {
  VectorXd sum = VectorXd::Zero(static_cast<Eigen::Index>(face.directions.size())), weights = sum;
  for (const HeadToAlign& head : heads) {
    const VectorXd radii = RadiiOf(head.radius, face, head.X_TM);
    for (Eigen::Index i = 0; i < radii.size(); ++i) {
      if (std::isnan(radii[i])) continue;
      sum[i] += head.weight * radii[i];
      weights[i] += head.weight;
    }
  }
  return sum.cwiseQuotient(weights);
}

/// By how much M should be moved so that the head's radii become @p wanted.
Vector3d Step(const RadiusFunction& head, const FaceRegion& face, const RigidTransform& X_TM) {
  const VectorXd radii = RadiiOf(head, face, X_TM);
  std::array<VectorXd, 3> moved;
  const Vector3d delta(kDelta_m, kDelta_m, kDelta_rad);
  for (int k = 0; k < 3; ++k)
    moved[static_cast<std::size_t>(k)] =
        RadiiOf(head, face, X_TM * Moved(delta[k] * Vector3d::Unit(k)));
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Vector3d g = Vector3d::Zero();
  int count = 0;
  for (Eigen::Index i = 0; i < radii.size(); ++i) {
    const double off = face.radii_m[i] - radii[i];
    Vector3d slope;
    for (int k = 0; k < 3; ++k)
      slope[k] = (moved[static_cast<std::size_t>(k)][i] - radii[i]) / delta[k];
    if (!std::isfinite(off) || !slope.allFinite()) continue;
    // A direction that slips over an edge tells no slope.
    if (slope.head<2>().cwiseAbs().maxCoeff() > 4 || std::abs(slope[2]) > 0.4) continue;
    const double w = 1 / (1 + off * off / (kRobust_m * kRobust_m));
    H += w * slope * slope.transpose();
    g += w * off * slope;
    ++count;
  }
  if (count < kFewest) return Vector3d::Zero();
  return H.ldlt().solve(g);
}

}  // namespace

FaceRegion FaceRegionOf(const std::function<float(const Vector3f& direction)>& radius) {
  FaceRegion face;
  std::vector<double> radii;
  const Icosphere sphere(kLevel);
  for (const Vector3f& direction : sphere.vertices()) {
    const float r = radius(direction);
    const Vector3f p = r * direction;
    if (std::abs(p.x()) < kHalfBreadth_m && p.y() > kTop_m && p.y() < kBottom_m &&
        p.z() < kRear_m) {
      face.directions.push_back(direction);
      radii.push_back(static_cast<double>(r));
    }
  }
  face.radii_m = VectorXd::Map(radii.data(), static_cast<Eigen::Index>(radii.size()));
  return face;
}

RigidTransform AlignHead(const RadiusFunction& head, const FaceRegion& face,
                         const RigidTransform& X_TM) {
  RigidTransform aligned = X_TM;
  for (int k = 0; k < kSteps; ++k) aligned = aligned * Moved(Step(head, face, aligned));
  return aligned;
}

void AlignHeads(const FaceRegion& face, std::vector<HeadToAlign>* heads) {
  double weights = 0;
  for (const HeadToAlign& head : *heads) weights += head.weight;
  for (int round = 0; round < kRounds; ++round) {
    FaceRegion mean = face;
    mean.radii_m = MeanRadii(*heads, face);
    std::vector<Vector3d> steps;
    Vector3d common = Vector3d::Zero();
    for (const HeadToAlign& head : *heads) {
      steps.push_back(Step(head.radius, mean, head.X_TM));
      common += head.weight / weights * steps.back();
    }
    for (std::size_t i = 0; i < heads->size(); ++i) {
      HeadToAlign& head = (*heads)[i];
      head.X_TM = head.X_TM * Moved(steps[i] - common);
    }
  }
  // The mean as one head; T is then its M.
  const RadiusFunction mean = [&](const RigidTransform& X, const Vector3f& direction) {
    double sum = 0, sum_weights = 0;
    for (const HeadToAlign& head : *heads) {
      const float radius = head.radius(head.X_TM * X, direction);
      if (std::isnan(radius)) continue;
      sum += head.weight * static_cast<double>(radius);
      sum_weights += head.weight;
    }
    return static_cast<float>(sum / sum_weights);
  };
  const RigidTransform X = AlignHead(mean, face, RigidTransform::Identity());
  for (HeadToAlign& head : *heads) head.X_TM = head.X_TM * X;
}

}  // namespace visavis
