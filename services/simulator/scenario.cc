#include "services/simulator/scenario.h"

#include <algorithm>
#include <cmath>

#include "common/config/config_error.h"
#include "common/core/random.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;
constexpr double kWayOut_m = 1.3;  ///< this far aside the head is out of both pictures

double Smooth(double t) {
  const double s = std::clamp(t, 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

}  // namespace

void ScenarioConfig::ValidateOrThrow() const {
  if (!head_phi_mm_deg.empty() && head_phi_mm_deg.size() != 6) {
    throw FieldError("scenario.head_phi_mm_deg",
                     std::to_string(head_phi_mm_deg.size()) + " numbers",
                     "must be six: t_x t_y t_z [mm] Phi theta psi [deg]");
  }
  if (random_min_z_mm > random_max_z_mm) {
    throw FieldError("scenario.random_min_z_mm", std::to_string(random_min_z_mm),
                     "must not exceed random_max_z_mm");
  }
  if (absent_from_s >= 0 && !(absent_until_s > absent_from_s)) {
    throw FieldError("scenario.absent_until_s", std::to_string(absent_until_s),
                     "must be later than absent_from_s");
  }
}

Scenario::Scenario(const ScenarioConfig& config, const RigidTransform& X_WC0, std::uint64_t seed)
    : config_(config), X_WC0_(X_WC0), X_C0M_(RigidTransform::Identity()), seed_(seed) {
  config.ValidateOrThrow();
  if (!config.head_phi_mm_deg.empty()) {
    Vector6d phi = Eigen::Map<const Vector6d>(config.head_phi_mm_deg.data());
    phi.head<3>() *= 1e-3;
    phi.tail<3>() *= kDegree;
    X_C0M_ = TransformFromPhi(phi);
  }
  X_C0M_.translation().z() += 1e-3 * config.distance_mm;
}

RigidTransform Scenario::CameraPose(double t_s) const {
  const double swing = std::cos(2 * M_PI * t_s / config_.period_s);
  RigidTransform X_C0C = RigidTransform::Identity();
  if (config_.name == "shuttle_x" || (config_.name == "moving_head" && config_.camera_moves)) {
    RigidTransform X_WC = X_WC0_;
    X_WC.translation().x() += 1e-3 * config_.amplitude_mm * swing;
    return X_WC;
  }
  if (config_.name == "orbit_theta") {
    // Turned about the vertical through the head's centre, looking at it.
    const Eigen::Vector3d centre = X_C0M_.translation();
    const double distance = centre.norm();
    const Eigen::Matrix3d towards =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), centre).toRotationMatrix();
    const Eigen::Matrix3d R_C0C =
        Eigen::AngleAxisd(kDegree * config_.amplitude_deg * swing, Eigen::Vector3d::UnitY()) *
        towards;
    X_C0C = MakeTransform(R_C0C, centre - distance * R_C0C.col(2));
  }
  return X_WC0_ * X_C0C;
}

Vector6d Scenario::HeadPhi(double t_s) const {
  Vector6d phi = Vector6d::Zero();
  if (config_.name == "moving_head") {
    // Sums of two sines whose amplitudes add up to one: smooth, and never beyond the limits.
    const auto sway = [&](double ratio, double phase) {
      const double w = 2 * M_PI * ratio / config_.head_period_s;
      return 0.65 * std::sin(w * t_s + phase) + 0.35 * std::sin(2.3 * w * t_s + 1.7 * phase);
    };
    const double travel = 1e-3 * config_.head_travel_mm, turn = kDegree * config_.head_turn_deg;
    phi << travel * sway(1, 0.3), 0.5 * travel * sway(1.31, 1.1), 0.8 * travel * sway(0.83, 2.2),
        0.6 * turn * sway(0.91, 0.7), turn * sway(1.07, 1.9), 0.9 * turn * sway(1.37, 2.9);
  }
  return phi;
}

double Scenario::WalkedAside(double t_s) const {
  if (config_.absent_from_s < 0) return 0;
  const double returned = 1e-3 * config_.return_shift_mm;
  if (config_.leave_s <= 0) return t_s < config_.absent_until_s ? 0 : returned;
  const double out = Smooth((t_s - config_.absent_from_s) / config_.leave_s + 1);
  const double in = Smooth((t_s - config_.absent_until_s) / config_.leave_s);
  return kWayOut_m * out + (returned - kWayOut_m) * in;
}

RigidTransform Scenario::HeadPose(double t_s) const {
  RigidTransform X_C0M = X_C0M_;
  if (config_.name == "random_poses") {
    const auto step =
        static_cast<std::uint64_t>(std::max(std::floor(t_s / config_.hold_s + 1e-9), 0.0));
    Random random(seed_ * 1000003 + step);
    const double xy = 1e-3 * config_.random_xy_mm, angle = kDegree * config_.random_deg;
    Vector6d phi;
    for (int i : {0, 1}) phi[i] = random.Uniform(-xy, xy);
    phi[2] = 1e-3 * random.Uniform(config_.random_min_z_mm, config_.random_max_z_mm);
    for (int i : {3, 4, 5}) phi[i] = random.Uniform(-angle, angle);
    X_C0M = TransformFromPhi(phi);
  } else {
    const Vector6d phi = HeadPhi(t_s);
    X_C0M = MakeTransform(Eigen::Matrix3d(X_C0M_.linear() * RotationFromAngles(phi.tail<3>())),
                          X_C0M_.translation() + phi.head<3>());
  }
  X_C0M.translation().x() += WalkedAside(t_s);
  return X_WC0_ * X_C0M;
}

bool Scenario::HeadPresent(double t_s) const {
  return config_.absent_from_s < 0 || t_s < config_.absent_from_s || t_s >= config_.absent_until_s;
}

}  // namespace visavis
