#pragma once

#include <cstdint>
#include <string>

#include "common/config/rule.h"
#include "common/geometry/rigid_transform.h"

namespace visavis {

/// How camera and head move.
struct ScenarioConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("name", &name,
             OneOf({"shuttle_x", "orbit_theta", "static", "moving_head", "random_poses"}));
    a->Visit("period_s", &period_s, InRange(0.2, 600.0, "s"));
    a->Visit("amplitude_mm", &amplitude_mm, InRange(0.0, 500.0, "mm"));
    a->Visit("amplitude_deg", &amplitude_deg, InRange(0.0, 45.0, "deg"));
    a->Visit("distance_mm", &distance_mm, InRange(400.0, 3000.0, "mm"));
    a->Visit("head_x_mm", &head_x_mm, InRange(-500.0, 500.0, "mm"));
    a->Visit("head_y_mm", &head_y_mm, InRange(-500.0, 500.0, "mm"));
    a->Visit("head_Phi_deg", &head_Phi_deg, InRange(-60.0, 60.0, "deg"));
    a->Visit("head_theta_deg", &head_theta_deg, InRange(-80.0, 80.0, "deg"));
    a->Visit("head_psi_deg", &head_psi_deg, InRange(-60.0, 60.0, "deg"));
    a->Visit("hold_s", &hold_s, InRange(0.1, 60.0, "s"));
    a->Visit("absent_from_s", &absent_from_s, InRange(0.0, 1e6, "s"));
    a->Visit("absent_until_s", &absent_until_s, InRange(0.0, 1e6, "s"));
  }
  /// shuttle_x: the camera goes along its x axis by amplitude_mm cos(2 pi t / period_s).
  /// orbit_theta: the camera circles the head at distance_mm, looking at its centre, by
  /// amplitude_deg cos(2 pi t / period_s). static: nothing moves. moving_head: the head nods, turns
  /// and sways, the camera rests. random_poses: the head jumps to a new pose every hold_s.
  std::string name{"shuttle_x"};
  double period_s{7};
  double amplitude_mm{150};
  double amplitude_deg{10};
  double distance_mm{1000};            ///< head from the nominal camera, along z
  double head_x_mm{6}, head_y_mm{-9};  ///< the head at rest, in the nominal camera
  double head_Phi_deg{2}, head_theta_deg{-4}, head_psi_deg{3};
  double hold_s{1};                            ///< random_poses: how long each pose is held
  double absent_from_s{0}, absent_until_s{0};  ///< no head between these times
};

/// The paper's experiments and others: where camera and head are at a time since the start.
class Scenario {
 public:
  /// @param X_WC0 the nominal pose of the right camera
  Scenario(const ScenarioConfig& config, const RigidTransform& X_WC0, std::uint64_t seed);

  /// X_WC that the arm is asked for.
  RigidTransform CameraPose(double time_s) const;
  /// X_WM.
  RigidTransform HeadPose(double time_s) const;
  bool HeadPresent(double time_s) const;

 private:
  RigidTransform RandomPose(std::int64_t index) const;

  ScenarioConfig config_;
  RigidTransform X_WC0_, X_WM0_;
  std::uint64_t seed_;
};

}  // namespace visavis
