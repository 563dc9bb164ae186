#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/refined/stereo_view.h"
#include "services/recogniser/search_space.h"

namespace visavis {

inline constexpr double kHeadRadius_m = 0.17;  ///< from M's origin: all of a head, and some more
inline constexpr double kFaceRadius_m = 0.12;  ///< likewise: all of a face
inline constexpr int kLeastBox_px = 32;        ///< a smaller part of a picture shows no head

/// The stereo pair at the resolution that the refined estimator works at, about 0.8 px a mm on the
/// head: larger pictures are halved until then, and of smaller ones a window is doubled, where one
/// of a bearable size shows all of the search space.
class WorkingPair {
 public:
  /// @p distance_m: where the head is expected. Nothing is doubled.
  /// @throws std::invalid_argument naming camera, field, value and rule for pictures that are too
  /// small at that resolution.
  WorkingPair(const StereoRig& rig, double distance_m);
  /// The head is expected in @p space. Doubled windows that look at its middle show a head anywhere
  /// in it.
  /// @throws std::invalid_argument likewise.
  WorkingPair(const StereoRig& rig, const SearchSpace& space);

  int halvings() const { return halvings_; }
  bool is_doubled() const { return is_doubled_; }
  /// The camera, or what it would be that takes the working picture.
  const EyeGeometry& eye(std::size_t i) const { return eyes_[i]; }
  /// [px] of the right camera's picture to a metre at @p distance_m.
  double detail(double distance_m) const { return cameras_[0].fx / distance_m; }
  /// Moves the windows of a doubled pair: @p p_C [m] in the right camera's frame is in their
  /// middle.
  void LookAt(const Eigen::Vector3d& p_C);
  /// The camera's picture, its halvings or its doubled window, of which Fill makes the pixels;
  /// nothing where @p frame has none. Right, left.
  std::optional<ImageView> Picture(const StereoFrame& frame, std::size_t i);
  /// The camera's picture that the last Picture was made of, while its frame lives.
  const ImageView& source(std::size_t i) const { return sources_[i]; }
  /// The pixels of the last Picture within @p box, while its frame lives. Borders must be even.
  void Fill(std::size_t i, const PixelBox& box);

  /// The pixels of eye @p i that a sphere round @p X_CM's origin covers, borders at multiples of
  /// 16 and within the picture.
  PixelBox BoxAround(std::size_t i, const RigidTransform& X_CM, double radius_m) const;
  PixelBox WholeBox(std::size_t i) const;

 private:
  int halvings_;
  bool is_doubled_{false};
  std::array<Pinhole, 2> cameras_;
  std::array<EyeGeometry, 2> eyes_;
  std::array<std::array<int, 2>, 2> corners_{};  ///< x, y of the windows in the pictures [px]
  std::array<std::vector<std::uint8_t>, 2> halved_, scratch_;
  std::array<ImageView, 2> sources_, windows_;
  std::array<PixelBox, 2> filled_;
  std::vector<std::uint16_t> blended_;
};

}  // namespace visavis
