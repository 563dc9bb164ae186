#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "services/simulator/colour.h"

namespace visavis {

/// What hangs and stands at the wall.
struct BackgroundConfig {
  double wall_z_m{2.2};         ///< distance of the wall from the nominal camera, 1.4 to 10
  bool skin_coloured{false};    ///< the wall itself in the colour of skin
  Srgb skin{0.80, 0.62, 0.53};  ///< that colour
  bool coarse{false};           ///< painted at a quarter of the resolution: in no time

  /// @throws std::invalid_argument naming field, value and range.
  void ValidateOrThrow() const;
};

/// A furnished wall: a plane z = wall_z in the scene's frame S (nominal camera axes), painted by
/// program. Reaches 5.12 x 2.56 m round the optical axis and repeats beyond.
class Background {
 public:
  /// Pixels sampled at once.
  static constexpr int kRun = 8;

  Background(const BackgroundConfig& config, std::uint64_t seed);

  /// What a camera at @p p_SC sees along the rays R_SC (x[i], y[i], 1), bilinear: red in the low
  /// byte of @p rgb[i]. Arrays of kRun.
  void Sample(const Eigen::Vector3f& p_SC, const Eigen::Matrix3f& R_SC, const float* x,
              const float* y, std::uint32_t* rgb) const;

 private:
  std::uint32_t Bilinear(int fx, int fy) const;

  float wall_z_;
  std::vector<std::uint32_t>
      picture_;  ///< one column and row more than the picture: its first again
};

}  // namespace visavis
