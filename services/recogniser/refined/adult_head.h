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
  /// At (@p x_m, @p y_m) in M of a head that has its features where adults have them.
  Place At(float x_m, float y_m) const;

  int columns, rows;
  float left_m, top_m, step_m;
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
