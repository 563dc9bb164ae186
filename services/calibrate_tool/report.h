#pragma once

#include <string>
#include <vector>

#include "services/calibrate_tool/hand_eye_solver.h"
#include "services/calibrate_tool/stereo_solver.h"
#include "services/calibrate_tool/view_collector.h"

namespace visavis {

/// Draws a PNG: where the corners lie in both images, coloured by how far off they are,
/// and each view's reprojection error.
/// @throws std::runtime_error naming the file that cannot be written.
void DrawStereoReport(const std::string& file, const Board& board,
                      const std::vector<StereoView>& views, const StereoCalibration& calibration);

/// Draws a PNG: where the hand was turned, and each view's residual in mm and deg.
void DrawHandEyeReport(const std::string& file, const std::vector<ArmView>& views,
                       const HandEyeCalibration& calibration);

}  // namespace visavis
