#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/image/image.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/face_points.h"

namespace visavis {

/// A picture's brightness in two spatial bands, over one box of it: differences of levels of a
/// Gaussian pyramid. The fine band has half of the picture's resolution, the coarse a quarter.
class BandImages {
 public:
  /// Allocates for pictures of @p width x @p height px.
  BandImages(int width, int height);

  /// Computes both bands within @p box, whose borders must be multiples of 8. No allocation.
  /// @p image: kGray, kRgb or kBgr.
  void Build(const ImageView& image, const PixelBox& box);

  /// Value and gradient at picture coordinates (u, v) [px of the picture]. false outside of the
  /// box, or within two samples of its border. Gradient a px of the picture.
  struct Sample {
    float value, du, dv;
  };
  bool At(Band band, float u, float v, Sample* sample) const;
  /// The value alone, at the nearest sample; false outside.
  bool Nearest(Band band, float u, float v, float* value) const {
    const Plane& plane = bands_[band];
    const float scale = band == kFineBand ? 0.5f : 0.25f;
    const float x = (u + 0.5f - static_cast<float>(box_.x0)) * scale;
    const float y = (v + 0.5f - static_cast<float>(box_.y0)) * scale;
    if (!(x >= 0 && y >= 0 && x < static_cast<float>(plane.width) &&
          y < static_cast<float>(plane.height))) {
      return false;
    }
    *value = plane.row(static_cast<int>(y))[static_cast<int>(x)];
    return true;
  }

 private:
  struct Plane {
    std::vector<float> data;
    int width{0}, height{0};
    float* row(int y) { return data.data() + static_cast<std::ptrdiff_t>(y) * width; }
    const float* row(int y) const { return data.data() + static_cast<std::ptrdiff_t>(y) * width; }
  };
  void Resize(Plane* plane, int width, int height) const;
  void HalfBrightness(const ImageView& image, const PixelBox& box);
  static void Halve(const Plane& from, Plane* to);
  void Smooth3(const Plane& from, Plane* to);
  void Smooth5(const Plane& from, Plane* to);
  static void SubtractDoubled(const Plane& from, const Plane& coarse, Plane* to);

  PixelBox box_;
  Plane half_, quarter_, eighth_, smooth_half_, smooth_quarter_, wide_, wider_, scratch_;
  std::array<Plane, kNumBands> bands_;
};

}  // namespace visavis
