#pragma once

#include <string>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/calibrate_tool/board.h"

namespace visavis {

/// Which of a lens' coefficients are free; the others stay 0.
enum class DistortionModel { kNone, kRadial, kPlumbBob4, kPlumbBob5 };

struct StereoSettings {
  int width{0}, height{0};            ///< of the right image [px]
  int left_width{0}, left_height{0};  ///< of the left
  DistortionModel distortion{DistortionModel::kPlumbBob5};
  double outlier_px{1.0};  ///< corners farther off than this count less and less (Huber)
};

/// Standard deviations, from the scatter of the corners round the solution.
struct CameraSigma {
  double fx, fy, cx, cy;             ///< [px]
  std::array<double, 5> distortion;  ///< k1 k2 p1 p2 k3; 0 where it is fixed
};

struct StereoCalibration {
  StereoRig rig;
  CameraSigma right_sigma, left_sigma;
  Eigen::Vector3d p_CL_sigma_m;      ///< of X_CL's position
  Eigen::Vector3d r_CL_sigma_rad;    ///< of its rotation, about L's axes
  double rms_px{0};                  ///< of all corners: root mean square of their distance
  std::vector<double> right_rms_px;  ///< of each view; NaN: not seen
  std::vector<double> left_rms_px;
  std::vector<RigidTransform> X_CT;  ///< pose of the board in each view
};

/// Calibrates both cameras and where they stand to each other: closed forms as a start, then all
/// corners of all views at once. Needs views that are tilted and at several distances, the board
/// in both pictures in some of them.
/// @throws std::invalid_argument saying what is missing.
StereoCalibration CalibrateStereo(const Board& board, const std::vector<StereoView>& views,
                                  const StereoSettings& settings);

}  // namespace visavis
