#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/geometry/head_angles.h"

namespace visavis {

/// Of one component of the error over some frames. Nothing where there are no frames.
struct Statistics {
  double rmse{0};
  double mean{0};  ///< of the absolute error
  double max{0};   ///< of the absolute error
  double bias{0};  ///< mean of the signed error
};

/// Errors of frames (Eqs. 33 to 36: truth minus estimate in C; angles of R_d^T R^i).
struct ErrorStatistics {
  std::array<std::optional<Statistics>, 3> position_m;  ///< x, y, z
  /// Of the distance; its bias is the length of the mean error.
  std::optional<Statistics> position_norm_m;
  std::array<std::optional<Statistics>, 3> angle_rad;  ///< Phi, theta, psi
  /// Of the geodesic angle; its bias is the length of the mean of the three angles.
  std::optional<Statistics> total_angle_rad;
};

/// Statistics of one signed component; nothing for no values.
std::optional<Statistics> ComputeStatistics(const std::vector<double>& errors);

ErrorStatistics ComputeErrorStatistics(const std::vector<RecognitionError>& errors);

/// The @p share (0 to 1) quantile, interpolated between the two nearest values; nothing for no
/// values.
std::optional<double> Quantile(std::vector<double> values, double share);

}  // namespace visavis
