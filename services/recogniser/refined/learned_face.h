#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "services/recogniser/refined/face_points.h"

namespace visavis {

/// A face as it was learned and is to be remembered: a few hundred points of its surface.
struct LearnedFace {
  std::vector<Eigen::Vector3f> points, normals;  ///< M frame, m
  /// Brightness there in each band, arbitrary units.
  std::array<std::vector<float>, kNumBands> value;
};

}  // namespace visavis
