#pragma once

#include <string>
#include <vector>

#include "common/rigs/rig_description.h"
#include "services/calibrate_tool/hand_eye_solver.h"
#include "services/calibrate_tool/stereo_solver.h"

namespace visavis {

/// For a reader: each view's reprojection error, cameras and X_CL with standard deviations.
std::string StereoText(const std::vector<StereoView>& views, const StereoCalibration& calibration);

/// For a reader: each view's residual, X_HC with standard deviations.
std::string HandEyeText(const std::vector<ArmView>& views, const HandEyeCalibration& calibration);

/// As rig.yaml keeps it.
RigUncertainty UncertaintyOf(const StereoCalibration& calibration);

/// Sets that of X_HC; a rig that has none of its cameras stays without.
void AddUncertainty(const HandEyeCalibration& calibration, RigDescription* rig);

}  // namespace visavis
