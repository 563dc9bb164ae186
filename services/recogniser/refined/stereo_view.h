#pragma once

#include <array>

#include "services/recogniser/refined/band_images.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/score_map.h"

namespace visavis {

/// What one eye shows of the current frame. Null pointers: that eye has no picture.
struct EyeView {
  const EyeGeometry* geometry{nullptr};
  const ScoreMap* scores{nullptr};
  const BandImages* bands{nullptr};

  bool seen() const { return scores != nullptr; }
};

/// Both eyes: right, left.
using StereoView = std::array<EyeView, 2>;

}  // namespace visavis
