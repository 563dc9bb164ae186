#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

inline constexpr double kHeadRadius_m = 0.17;  ///< from M's origin: all of a head, and some more
inline constexpr int kLeastBox_px = 32;        ///< a smaller part of a picture shows no head

/// The stereo pair at the resolution that the refined estimator works at, about 0.8 px a mm on the
/// head: larger pictures are halved until then.
class WorkingPair {
 public:
  /// @p distance_m: where the head is expected.
  /// @throws std::invalid_argument naming camera, field, value and rule for pictures that are too
  /// small at that resolution.
  WorkingPair(const StereoRig& rig, double distance_m);

  int halvings() const { return halvings_; }
  const EyeGeometry& eye(std::size_t i) const { return eyes_[i]; }
  /// The camera's picture, or its halvings; nothing where @p frame has none. Right, left.
  std::optional<ImageView> Picture(const StereoFrame& frame, std::size_t i);

  /// The pixels of eye @p i that a sphere round @p X_CM's origin covers, borders at multiples of
  /// 16 and within the picture.
  PixelBox BoxAround(std::size_t i, const RigidTransform& X_CM, double radius_m) const;
  PixelBox WholeBox(std::size_t i) const;

 private:
  int halvings_;
  std::array<EyeGeometry, 2> eyes_;
  std::array<std::vector<std::uint8_t>, 2> halved_, scratch_;
};

}  // namespace visavis
