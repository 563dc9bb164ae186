#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_surface.h"
#include "tests/people/trained_head.h"

namespace visavis {

/// What one picture shows at the cells of the grid, by band [levels]; NaN where not seen.
using LooksView = std::array<std::vector<float>, kNumBands>;

/// Looks at the faces of recordings through the surface of the mean head.
class LooksSampler {
 public:
  LooksSampler(const LooksGrid& grid, const HeadSurface& mean);

  /// Every picture of both eyes in @p log that has a truth, of a head whose frame T has M at
  /// @p X_TM.
  /// @throws std::runtime_error where it can't be read.
  std::vector<LooksView> Sample(const std::string& log, const RigidTransform& X_TM) const;

  /// Whether the grid's line through the cell meets the surface outside of the hair.
  const std::vector<bool>& on_face() const { return on_face_; }

 private:
  FacePoints points_;
  std::vector<bool> on_face_;
};

}  // namespace visavis
