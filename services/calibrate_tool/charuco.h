#pragma once

// For board and detector alone.

#include <opencv2/aruco/charuco.hpp>

#include "services/calibrate_tool/board.h"

namespace visavis {

/// OpenCV's description of a charuco board.
cv::Ptr<cv::aruco::CharucoBoard> MakeCharuco(const BoardSpec& spec);

}  // namespace visavis
