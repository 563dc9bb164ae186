#pragma once

#include <array>

#include "services/recogniser/refined/band_images.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/score_map.h"

namespace visavis {

/// What one eye shows of the current frame. Null pointers: that eye has no picture; no scores
/// alone: only brightness was looked at.
struct EyeView {
  const EyeGeometry* geometry{nullptr};
  const ScoreMap* scores{nullptr};
  const BandImages* bands{nullptr};

  /// It sees nothing.
  void Close() {
    scores = nullptr;
    bands = nullptr;
  }
  /// Brightness, that is; who needs colours asks scores.
  bool seen() const { return bands != nullptr; }
};

/// Both eyes: right, left.
using StereoView = std::array<EyeView, 2>;

}  // namespace visavis
