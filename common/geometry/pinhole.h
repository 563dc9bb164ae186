#pragma once

#include <Eigen/Core>
#include <array>

namespace visavis {

/// One camera: pinhole with OpenCV's five distortion coefficients. Pixel (0, 0) is the centre of
/// the first pixel; camera axes x right, y down, z forward.
struct Pinhole {
  int width{0}, height{0};                          ///< [px]
  double fx{0}, fy{0};                              ///< [px]
  double cx{0}, cy{0};                              ///< [px]
  std::array<double, 5> distortion{0, 0, 0, 0, 0};  ///< k1 k2 p1 p2 k3

  bool has_distortion() const { return distortion != std::array<double, 5>{}; }

  /// @throws std::invalid_argument naming field, value and rule.
  void ValidateOrThrow() const;
};

/// Pixel coordinates of a point; meaningful only where valid.
struct Projection {
  Eigen::Vector2d uv;  ///< [px]
  bool valid;          ///< z > 0 (the pixel may lie outside the image)
};

/// Projects p_C [m], Eqs. 18 and 20.
Projection Project(const Pinhole& camera, const Eigen::Vector3d& p_C);

/// Ray through pixel @p uv: direction in C with z = 1, distortion undone by fixed-point iteration
/// (error below 1e-9 for lenses whose distortion is monotone in the image).
Eigen::Vector3d Unproject(const Pinhole& camera, const Eigen::Vector2d& uv);

}  // namespace visavis
