#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_surface.h"

namespace visavis {

/// How faces look from the front, by place: what they have in common and how they differ, in each
/// band, brightness in units of the face's own contrast.
class AdultLooks {
 public:
  static constexpr int kModes = kLooksModes;

  struct Place {
    std::array<float, kNumBands> mean{};
    float doubt{1};                     ///< fine band: standard deviation that the modes leave
    std::array<float, kModes> modes{};  ///< fine band: one standard deviation of each
    bool known{false};
  };
  /// A face is value = gain (mean + modes a + what remains) + offset, a of variance 1. What remains
  /// is of the variance doubt^2 + kOwnDoubt^2, and so alike for neighbours that a place is worth
  /// kIndependence of one; the gain is at least kLeastGain of what would explain all contrast.
  static constexpr float kOwnDoubt = 0.2f, kIndependence = 0.12f, kLeastGain = 0.4f;
  static float Weight(float doubt) { return 1 / (doubt * doubt + kOwnDoubt * kOwnDoubt); }

  /// At (@p x_m, @p y_m) in M of a head that has its features where adults have them.
  Place At(float x_m, float y_m) const;

  int columns{0}, rows{0};
  float left_m{0}, top_m{0}, step_m{1};
  std::vector<Place> cells;
};

/// What is known of a head before it is seen, learned from many (scripts/train-head).
struct AdultHead {
  HeadSurface surface;
  /// How faces' shapes differ: radii [m] by vertex of the surface's table, one standard deviation
  /// of each mode a column.
  Eigen::MatrixXd shape_modes_m;
  AdultLooks looks;
};

/// The same for all.
const AdultHead& TheAdult();

}  // namespace visavis
