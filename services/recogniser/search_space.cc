#include "services/recogniser/search_space.h"

#include <cmath>

#include "common/config/config_error.h"

namespace visavis {
namespace {

// The nearest that a head's centre may come to a camera: the model must lie in front of it.
constexpr double kMinDepthM = 0.3;
constexpr double kFarthestM = 10;

}  // namespace

void SearchSpaceConfig::ValidateOrThrow(const std::string& prefix) const {
  const auto require = [&](double min, double max, const char* min_key, const char* max_key) {
    if (!(max - min >= 10)) {
      throw FieldError(prefix + max_key, std::to_string(max),
                       "must exceed " + prefix + min_key + " by 10 mm");
    }
  };
  require(min_x_mm, max_x_mm, "min_x_mm", "max_x_mm");
  require(min_y_mm, max_y_mm, "min_y_mm", "max_y_mm");
  require(min_z_mm, max_z_mm, "min_z_mm", "max_z_mm");
  if (!nearest_to.empty() && nearest_to.size() != 3) {
    throw FieldError(prefix + "nearest_to", std::to_string(nearest_to.size()) + " numbers",
                     "must be x y z, or none");
  }
  for (const double x : nearest_to) {
    if (!(std::abs(x) <= kFarthestM)) {
      throw FieldError(prefix + "nearest_to", std::to_string(x), "must each be -10 to 10 m");
    }
  }
}

std::optional<Eigen::Vector3d> SearchSpaceConfig::NearestTo() const {
  if (nearest_to.empty()) return std::nullopt;
  return Eigen::Vector3d(nearest_to[0], nearest_to[1], nearest_to[2]);
}

SearchSpace SearchSpace::FromConfig(const SearchSpaceConfig& config) {
  SearchSpaceConfig c = config.preset == "custom" ? config : SearchSpaceConfig{};
  if (config.preset == "paper") {
    c.min_x_mm = c.min_y_mm = -100;
    c.max_x_mm = c.max_y_mm = 100;
  }
  const auto angle = [&](double own_deg) {
    return (own_deg > 0 ? own_deg : c.max_angle_deg) * M_PI / 180;
  };
  const double phi = angle(c.max_phi_deg), theta = angle(c.max_theta_deg),
               psi = angle(c.max_psi_deg);
  SearchSpace space;
  space.min << c.min_x_mm / 1000, c.min_y_mm / 1000, c.min_z_mm / 1000, -phi, -theta, -psi;
  space.max << c.max_x_mm / 1000, c.max_y_mm / 1000, c.max_z_mm / 1000, phi, theta, psi;
  return space;
}

SearchSpace SearchSpace::CentredOn(const Eigen::Vector3d& p_CM) const {
  SearchSpace moved = *this;
  const Eigen::Vector3d half = 0.5 * range().head<3>();
  moved.min.head<3>() = p_CM - half;
  moved.max.head<3>() = p_CM + half;
  if (moved.min[2] < kMinDepthM) {
    moved.max[2] += kMinDepthM - moved.min[2];
    moved.min[2] = kMinDepthM;
  }
  return moved;
}

bool Recentres(const SearchSpaceConfig& config) {
  return config.preset == "custom" ? config.recentre : config.preset == "wide";
}

}  // namespace visavis
