#include "services/simulator/scenario.h"

#include <cmath>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;

double Wave(double time_s, double period_s, double phase = 0) {
  return std::cos(2 * M_PI * time_s / period_s + phase);
}

}  // namespace

Scenario::Scenario(const ScenarioConfig& config, const RigidTransform& X_WC0, std::uint64_t seed)
    : config_(config), X_WC0_(X_WC0), seed_(seed) {
  Vector6d phi;
  phi << config.head_x_mm / 1000, config.head_y_mm / 1000, config.distance_mm / 1000,
      config.head_Phi_deg * kDegree, config.head_theta_deg * kDegree, config.head_psi_deg * kDegree;
  X_WM0_ = X_WC0 * TransformFromPhi(phi);
}

RigidTransform Scenario::CameraPose(double time_s) const {
  RigidTransform X_WC = X_WC0_;
  const double wave = Wave(time_s, config_.period_s);
  if (config_.name == "shuttle_x") {
    X_WC.translation() += X_WC0_.linear().col(0) * config_.amplitude_mm / 1000 * wave;
  } else if (config_.name == "orbit_theta") {
    const Eigen::Matrix3d R = RotationFromAngles({0, config_.amplitude_deg * kDegree * wave, 0});
    const Eigen::Vector3d p_CoM = X_WC0_.inverse() * X_WM0_.translation();
    // Round the head's centre, whichever way the head itself looks.
    X_WC.linear() = X_WC0_.linear() * R;
    X_WC.translation() = X_WM0_.translation() - X_WC.linear() * Eigen::Vector3d(0, 0, p_CoM.norm());
  }
  return X_WC;
}

// A pose anywhere in the recogniser's default search space.
RigidTransform Scenario::RandomPose(std::int64_t index) const {
  Random random(seed_ * 1'000'003 + static_cast<std::uint64_t>(index));
  Vector6d phi;
  phi << random.Uniform(-0.15, 0.15), random.Uniform(-0.10, 0.10), random.Uniform(0.92, 1.18),
      random.Uniform(-18, 18) * kDegree, random.Uniform(-18, 18) * kDegree,
      random.Uniform(-18, 18) * kDegree;
  return X_WC0_ * TransformFromPhi(phi);
}

RigidTransform Scenario::HeadPose(double time_s) const {
  if (config_.name == "random_poses") {
    return RandomPose(static_cast<std::int64_t>(std::floor(time_s / config_.hold_s)));
  }
  if (config_.name != "moving_head") return X_WM0_;
  // Three turns and a sway of different periods, as a person listens; the seed shifts their phases.
  Random random(seed_ + 17);
  Vector6d phi = PhiFromTransform(X_WC0_.inverse() * X_WM0_);
  const double amplitude[6] = {0.06, 0.02, 0.03, 5 * kDegree, 12 * kDegree, 8 * kDegree};
  const double period_s[6] = {6.1, 4.3, 7.9, 5.3, 3.7, 2.9};
  for (int k = 0; k < 6; ++k) {
    phi[k] += amplitude[k] * Wave(time_s, period_s[k], random.Uniform(0, 2 * M_PI));
  }
  return X_WC0_ * TransformFromPhi(phi);
}

bool Scenario::HeadPresent(double time_s) const {
  return time_s < config_.absent_from_s || time_s >= config_.absent_until_s;
}

}  // namespace visavis
