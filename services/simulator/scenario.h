#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "common/geometry/head_angles.h"
#include "common/geometry/rigid_transform.h"

namespace visavis {

/// How camera and head move. Lengths in mm and angles in deg, as people write them.
struct ScenarioConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("name", &name,
             OneOf({"shuttle_x", "orbit_theta", "static", "moving_head", "random_poses"}));
    a->Visit("period_s", &period_s, InRange(0.2, 3600.0, "s"));
    a->Visit("amplitude_mm", &amplitude_mm, InRange(0.0, 1000.0, "mm"));
    a->Visit("amplitude_deg", &amplitude_deg, InRange(0.0, 60.0, "deg"));
    a->Visit("distance_mm", &distance_mm, InRange(400.0, 5000.0, "mm"));
    a->Visit("head_phi_mm_deg", &head_phi_mm_deg);
    a->Visit("head_travel_mm", &head_travel_mm, InRange(0.0, 500.0, "mm"));
    a->Visit("head_turn_deg", &head_turn_deg, InRange(0.0, 60.0, "deg"));
    a->Visit("head_period_s", &head_period_s, InRange(0.5, 3600.0, "s"));
    a->Visit("camera_moves", &camera_moves);
    a->Visit("hold_s", &hold_s, InRange(0.03, 3600.0, "s"));
    a->Visit("random_xy_mm", &random_xy_mm, InRange(0.0, 1000.0, "mm"));
    a->Visit("random_min_z_mm", &random_min_z_mm, InRange(300.0, 5000.0, "mm"));
    a->Visit("random_max_z_mm", &random_max_z_mm, InRange(300.0, 5000.0, "mm"));
    a->Visit("random_deg", &random_deg, InRange(0.0, 60.0, "deg"));
    a->Visit("absent_from_s", &absent_from_s);
    a->Visit("absent_until_s", &absent_until_s);
    a->Visit("leave_s", &leave_s, InRange(0.0, 60.0, "s"));
    a->Visit("return_shift_mm", &return_shift_mm, InRange(-1000.0, 1000.0, "mm"));
  }
  /// @throws std::invalid_argument naming field, value and rule, for rules between fields.
  void ValidateOrThrow() const;

  /// shuttle_x: the camera along W's x axis (the paper's position experiment); orbit_theta: the
  /// camera round the head, looking at its centre (the orientation experiment); static: nothing
  /// moves; moving_head: the head nods, turns and sways; random_poses: the head jumps.
  std::string name{"shuttle_x"};
  double period_s{15};       ///< of the camera's motion; the paper: 15 and 7, 20 and 10
  double amplitude_mm{150};  ///< shuttle_x
  double amplitude_deg{10};  ///< orbit_theta
  double distance_mm{1000};  ///< nominal camera to head
  /// Offset of the head from its nominal place: t_x t_y t_z [mm] Phi theta psi [deg] in the nominal
  /// camera; empty: none. Not zero by default, so that no mistake hides behind a zero.
  std::vector<double> head_phi_mm_deg{6, -9, 0, 2, -4, 3};
  double head_travel_mm{80};  ///< moving_head: greatest way from the nominal place
  double head_turn_deg{15};   ///< moving_head: greatest angle
  double head_period_s{6};    ///< moving_head: of its slowest part
  bool camera_moves{false};   ///< moving_head: with shuttle_x of the camera
  double hold_s{1};           ///< random_poses: time between two jumps
  double random_xy_mm{200};   ///< random_poses: range of t_x and t_y
  double random_min_z_mm{900}, random_max_z_mm{1200};
  double random_deg{20};                         ///< random_poses: range of each angle
  double absent_from_s{-1}, absent_until_s{-1};  ///< the head is away between the two; < 0: never
  double leave_s{0};          ///< takes so long to walk out and in again; 0: vanishes at once
  double return_shift_mm{0};  ///< comes back so far to the right of where it was
};

/// Where camera and head are to be at any time: a pure function of configuration, seed and time.
class Scenario {
 public:
  /// @p X_WC0: nominal pose of the right camera; the head's nominal place is straight before it.
  Scenario(const ScenarioConfig& config, const RigidTransform& X_WC0, std::uint64_t seed);

  /// Desired X_WC.
  RigidTransform CameraPose(double t_s) const;
  /// X_WM, also while the head is away.
  RigidTransform HeadPose(double t_s) const;
  /// False while the head is out of the room.
  bool HeadPresent(double t_s) const;

  const RigidTransform& X_WC0() const { return X_WC0_; }
  const ScenarioConfig& config() const { return config_; }

 private:
  /// X_C0M without leaving and returning.
  Vector6d HeadPhi(double t_s) const;
  /// Way to the side [m] while walking out and in.
  double WalkedAside(double t_s) const;

  ScenarioConfig config_;
  RigidTransform X_WC0_;
  RigidTransform X_C0M_;  ///< nominal, with the configured offset
  std::uint64_t seed_;
};

}  // namespace visavis
