#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "common/geometry/head_angles.h"

namespace visavis {

/// Range of phi = [t_x t_y t_z Phi theta psi] that genes can express.
struct SearchSpaceConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("preset", &preset, OneOf({"wide", "paper", "custom"}));
    a->Visit("min_x_mm", &min_x_mm, InRange(-3000.0, 3000.0, "mm"));
    a->Visit("max_x_mm", &max_x_mm, InRange(-3000.0, 3000.0, "mm"));
    a->Visit("min_y_mm", &min_y_mm, InRange(-3000.0, 3000.0, "mm"));
    a->Visit("max_y_mm", &max_y_mm, InRange(-3000.0, 3000.0, "mm"));
    a->Visit("min_z_mm", &min_z_mm, InRange(300.0, 5000.0, "mm"));
    a->Visit("max_z_mm", &max_z_mm, InRange(300.0, 5000.0, "mm"));
    a->Visit("max_angle_deg", &max_angle_deg, InRange(1.0, 80.0, "deg"));
    a->Visit("max_phi_deg", &max_phi_deg, InRange(0.0, 80.0, "deg"));
    a->Visit("max_theta_deg", &max_theta_deg, InRange(0.0, 80.0, "deg"));
    a->Visit("max_psi_deg", &max_psi_deg, InRange(0.0, 80.0, "deg"));
    a->Visit("recentre", &recentre);
    a->Visit("nearest_to", &nearest_to);
  }
  /// @throws FieldError, keys under @p prefix.
  void ValidateOrThrow(const std::string& prefix) const;

  /// wide: +-200 mm, 900 to 1200 mm, +-20 deg, recentred on the head while TRACKING. paper: the
  /// published +-100 mm, fixed. custom: the keys below.
  std::string preset{"wide"};
  double min_x_mm{-200}, max_x_mm{200};
  double min_y_mm{-200}, max_y_mm{200};
  double min_z_mm{900}, max_z_mm{1200};
  double max_angle_deg{20};  ///< each of Phi, theta, psi within +- this
  /// One axis by itself: about the optical axis, the vertical, the horizontal; 0: max_angle_deg.
  double max_phi_deg{0}, max_theta_deg{0}, max_psi_deg{0};
  bool recentre{true};  ///< custom: move the position's range with the tracked head
  /// [m] x y z in C: of several faces in view the one nearest to it is taken at the start; empty:
  /// one that clearly looks like a face, or else the one that does most. Estimator refined.
  std::vector<double> nearest_to;

  std::optional<Eigen::Vector3d> NearestTo() const;
};

/// The box of poses that the GA searches.
struct SearchSpace {
  Vector6d min, max;  ///< m, rad

  static SearchSpace FromConfig(const SearchSpaceConfig& config);

  Vector6d range() const { return max - min; }
  Vector6d middle() const { return 0.5 * (min + max); }
  /// [m] along the optical axis, of the middle.
  double distance() const { return 0.5 * (min[2] + max[2]); }
  Vector6d Clamp(const Vector6d& phi) const { return phi.cwiseMax(min).cwiseMin(max); }
  bool Contains(const Vector6d& phi) const {
    return (phi.array() >= min.array()).all() && (phi.array() <= max.array()).all();
  }
  /// Whether a parameter of @p phi lies outside or within @p share of its range from an end.
  bool AtBorder(const Vector6d& phi, double share) const {
    const Vector6d margin = share * range();
    return !SearchSpace{min + margin, max - margin}.Contains(phi);
  }
  /// The same extent, its positions centred on @p p_CM [m]; the angles stay.
  SearchSpace CentredOn(const Eigen::Vector3d& p_CM) const;
};

/// Whether the configured space follows the tracked head.
bool Recentres(const SearchSpaceConfig& config);

}  // namespace visavis
