#pragma once

#include <array>

#include "services/recogniser/refined/kernel_types.h"
#include "services/recogniser/refined/pose_equations.h"

namespace visavis {

/// Measurements for the normal equations (see PoseEquations::Add), up to kSize at a time.
struct EquationRows {
  static constexpr int kSize = 256;
  using Column = std::array<float, kSize>;

  int n{0};  ///< a multiple of kLanes; rows of weight 0 fill up
  Column slope_x, slope_y, slope_z, arm_x, arm_y, arm_z, residual, weight;
};

/// Sums of rows in single precision, lane by lane: equal on every SIMD target.
class EquationSums {
 public:
  static constexpr int kTerms = 27;  ///< lower half of H, column by column; g

  /// Adds all of @p rows. Slopes and arms of rows of weight 0 must be finite.
  void Add(const EquationRows& rows);
  /// Adds what was summed up to @p equations.
  void AddTo(PoseEquations* equations) const;

 private:
  float lanes_[kTerms][kLanes]{};
};

}  // namespace visavis
