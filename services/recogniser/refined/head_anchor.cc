#include "services/recogniser/refined/head_anchor.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr std::size_t kMaxViews = 200;
constexpr double kSameView_rad = 0.06;
constexpr int kMemory = 30;       ///< frames a view's mean looks back
constexpr double kUnseen = 1e-6;  ///< of the largest eigenvalue: a direction that no view tells
constexpr double kMaxStep_m = 0.002, kMaxStep_rad = 0.01;  ///< a frame

}  // namespace

HeadAnchor::HeadAnchor() { views_.reserve(kMaxViews); }

void HeadAnchor::Forget() { views_.clear(); }

void HeadAnchor::Add(const Eigen::Vector3d& direction, const PoseEquations& generic) {
  View* nearest = nullptr;
  double best = -2;
  for (View& view : views_) {
    const double cosine = view.direction.dot(direction);
    if (cosine <= best) continue;
    best = cosine;
    nearest = &view;
  }
  if (nearest == nullptr || (best < std::cos(kSameView_rad) && views_.size() < kMaxViews)) {
    views_.push_back({direction, generic, 1});
    return;
  }
  nearest->count = std::min(nearest->count + 1, kMemory);
  const double rate = 1.0 / nearest->count;
  nearest->mean.H += rate * (generic.H - nearest->mean.H);
  nearest->mean.g += rate * (generic.g - nearest->mean.g);
}

RigidTransform HeadAnchor::Correct() {
  PoseEquations sum;
  for (const View& view : views_) {
    sum.H += view.mean.H;
    sum.g += view.mean.g;
  }
  // Along directions that no view tells the frame stays.
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(sum.H);
  const Vector6d& values = solver.eigenvalues();
  Vector6d along = solver.eigenvectors().transpose() * sum.g;
  for (int i = 0; i < 6; ++i) along[i] = values[i] > kUnseen * values[5] ? along[i] / values[i] : 0;
  Vector6d step = solver.eigenvectors() * along;
  if (!step.allFinite()) return RigidTransform::Identity();
  step.head<3>() *= std::min(1.0, kMaxStep_m / std::max(step.head<3>().norm(), 1e-12));
  step.tail<3>() *= std::min(1.0, kMaxStep_rad / std::max(step.tail<3>().norm(), 1e-12));
  for (View& view : views_) view.mean.g -= view.mean.H * step;
  return MakeTransform(ExpRotation(step.tail<3>()), Eigen::Vector3d(step.head<3>()));
}

}  // namespace visavis
