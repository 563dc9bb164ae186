#pragma once

#include <vector>

#include "common/core/random.h"
#include "services/calibrate_tool/board.h"
#include "services/calibrate_tool/hand_eye_solver.h"

namespace visavis {

/// A made-up rig on an arm before a board, whose truth is known.
struct BoardScene {
  Board board;
  StereoRig rig;                           ///< the truth
  RigidTransform X_HC, X_BT;               ///< the truth: cameras in the hand, board in the base
  std::vector<RigidTransform> X_CT, X_BH;  ///< of each view
};

/// Cameras like the demo's (f = 800 px, 150 mm apart) with lenses that distort and axes that do not
/// quite agree.
StereoRig SkewedRig();

/// A board of few squares of 60 mm, quickly seen.
BoardSpec SmallBoard(int columns, int rows);

/// @p num_views postures at which the board about fills the right image: turned to all sides by up
/// to 40 deg, nearer and farther, up to a seventh of the picture off its middle.
BoardScene MakeBoardScene(const BoardSpec& spec, int num_views, std::uint64_t seed);

/// What both cameras see of the board, each coordinate off by normal noise. Corners outside the
/// picture are not seen.
StereoView SeeCorners(const BoardScene& scene, const RigidTransform& X_CT, double noise_px,
                      Random* random);

/// All views of a scene with their postures.
std::vector<ArmView> SeeAll(const BoardScene& scene, double noise_px, std::uint64_t seed);

}  // namespace visavis
