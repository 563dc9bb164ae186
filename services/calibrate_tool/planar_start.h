#pragma once

#include <optional>
#include <vector>

#include "common/geometry/pinhole.h"
#include "common/geometry/rigid_transform.h"
#include "services/calibrate_tool/board.h"

namespace visavis {

/// Fewest corners of a view that give a pose.
constexpr int kMinCorners = 6;

/// Focal length from the views' homographies, principal point in the middle, no distortion.
/// @throws std::invalid_argument where too few views show enough.
Pinhole StartCamera(const Board& board, const std::vector<const BoardView*>& views, int width,
                    int height);

/// Pose of the board in the camera from one view; none where it shows too little.
std::optional<RigidTransform> StartPose(const Board& board, const BoardView& view,
                                        const Pinhole& camera);

}  // namespace visavis
