#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/image/image.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/face_kernel.h"
#include "services/recogniser/refined/face_points.h"

namespace visavis {

/// A picture's brightness in two spatial bands, over one box of it: differences of levels of a
/// Gaussian pyramid. The fine band has half of the picture's resolution, the coarse a quarter. In
/// integers: the same bits on every SIMD target.
class BandImages {
 public:
  /// Allocates for pictures of up to @p width x @p height px.
  BandImages(int width, int height);

  /// Computes both bands within @p box, whose borders must be multiples of 8. No allocation.
  /// @p image: kGray, kRgb or kBgr.
  void Build(const ImageView& image, const PixelBox& box);

  /// As the kernels take it.
  BandView view(Band band) const;

 private:
  /// Brightness in units of kBandUnit.
  struct Plane {
    std::vector<std::uint16_t> data;
    int width{0}, height{0};
    std::uint16_t* row(int y) { return data.data() + std::ptrdiff_t{y} * width; }
    const std::uint16_t* row(int y) const { return data.data() + std::ptrdiff_t{y} * width; }
  };
  /// Samples of a band, each with its right neighbour; see BandView.
  struct PairPlane {
    std::vector<std::int32_t> data;
    int width{0}, height{0};
    std::int32_t* row(int y) { return data.data() + std::ptrdiff_t{y} * width; }
  };
  void HalfBrightness(const ImageView& image, const PixelBox& box);
  void BuildRed(const ImageView& image, const PixelBox& box);
  static void Halve(const Plane& from, Plane* to);
  void Smooth3(const Plane& from, Plane* to);
  void Smooth5(const Plane& from, Plane* to);
  static void PairUp(const Plane& from, PairPlane* to);
  void SubtractDoubled(const Plane& from, const Plane& coarse, PairPlane* to);

  PixelBox box_;
  Plane half_, red_, smooth_red_, quarter_, eighth_, smooth_half_, smooth_quarter_, wide_, wider_,
      scratch_;
  std::array<PairPlane, kNumPlanes> bands_;
  std::vector<std::uint16_t> row_, blended_;
};

}  // namespace visavis
