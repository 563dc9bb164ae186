#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "common/rigs/rig_description.h"
#include "services/calibrate_tool/board.h"

namespace visavis {

/// The board, at rest, seen from one posture of the arm.
struct ArmView {
  StereoView view;
  RigidTransform X_BH;  ///< hand in the arm's base, from the joints
};

struct HandEyeSettings {
  double arm_sigma_m{2e-4};    ///< how exactly the arm knows its hand's place, > 0
  double arm_sigma_rad{3e-4};  ///< and its direction, > 0
  double outlier_px{1.0};      ///< as in StereoSettings
  /// How exactly the rig is known: goes into the standard deviations. As if its numbers did not
  /// depend on each other, though they do, so that these are rather too large.
  std::optional<RigUncertainty> rig_uncertainty;
};

struct HandEyeCalibration {
  RigidTransform X_HC;             ///< pose of the right camera in the hand
  RigidTransform X_BT;             ///< pose of the board in the arm's base
  Eigen::Vector3d p_HC_sigma_m;    ///< standard deviations of X_HC's position
  Eigen::Vector3d r_HC_sigma_rad;  ///< and of its rotation, about C's axes
  std::string start;               ///< OpenCV's method whose answer was the start
  double rms_px{0};                ///< of all corners, each view's own pose of the board free
  /// Per view, the board where the cameras see it against where arm and X_HC put it. NaN: the view
  /// shows too little.
  std::vector<double> residual_m, residual_rad;
  double residual_rms_m{0}, residual_rms_rad{0};
};

/// Finds where the cameras are on the hand: OpenCV's methods as a start (the one that fits best),
/// then X_HC, X_BT and the arm's own errors in each view at once, to the corners in both images.
/// Needs views whose hands are turned about at least two axes.
/// @throws std::invalid_argument saying what is missing.
HandEyeCalibration CalibrateHandEye(const Board& board, const StereoRig& rig,
                                    const std::vector<ArmView>& views,
                                    const HandEyeSettings& settings);

/// Pose of the board in the right camera from both images of one view, and the root mean square of
/// its corners [px]. @param X_CT  a start
RigidTransform RefineBoardPose(const Board& board, const StereoRig& rig, const StereoView& view,
                               const RigidTransform& X_CT, double* rms_px);

}  // namespace visavis
