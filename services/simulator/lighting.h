#pragma once

#include <Eigen/Geometry>
#include <cstdint>

namespace visavis {

/// The light in the room, fixed in the scene. Directions point from the scene to the light, camera
/// axes of the nominal camera (x right, y down, z forward); intensities are linear RGB, scaled so
/// that a white surface facing a light of 1 is rendered white.
struct Lighting {
  Eigen::Vector3f key_direction{-0.45f, -0.62f, -0.64f};
  Eigen::Vector3f key{0.62f, 0.60f, 0.57f};
  float key_radius{0.16f};  ///< sine of half the angle under which the lamp is seen: soft shadows
  Eigen::Vector3f fill_direction{0.72f, -0.18f, -0.67f};
  Eigen::Vector3f fill{0.17f, 0.18f, 0.20f};
  Eigen::Vector3f sky{0.37f, 0.38f, 0.40f};     ///< from above
  Eigen::Vector3f ground{0.20f, 0.18f, 0.16f};  ///< from below

  /// A lamp far to the side and little else: one half of the face dark.
  static Lighting Side();

  /// A lamp anywhere before the face, from soft to hard, warm to cold; the same for the same
  /// @p seed.
  static Lighting Random(std::uint64_t seed);
};

}  // namespace visavis
