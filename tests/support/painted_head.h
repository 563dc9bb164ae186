#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "common/image/image.h"
#include "services/recogniser/head_model.h"

namespace visavis {

/// An RGB picture of a head that is exactly the model: hair, skin, brows and eyes of flat colours
/// on a bright wall. One ray a pixel; slow, for tests and benchmarks of the recogniser alone.
class PaintedHead {
 public:
  PaintedHead(const HeadModelConfig& head, const Pinhole& camera);

  /// Paints the head at @p X_KM, its pose in this camera. @return a view that lives until the next
  /// call.
  ImageView Paint(const RigidTransform& X_KM);

 private:
  HeadModelConfig config_;
  HeadModel model_;
  Pinhole camera_;
  std::vector<std::uint8_t> rgb_;
};

/// A rig of two equal ideal cameras: 640x480 px, f = 800 px, baseline 150 mm.
StereoRig TestRig();

}  // namespace visavis
