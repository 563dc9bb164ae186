#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/config/rule.h"
#include "common/image/image.h"

namespace visavis {

/// The paper's fixed colour rules (Eqs. 26, 27), and what gates them.
struct ColorRuleConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("hair_min_p", &hair_min_p, InRange(0, 255));
    a->Visit("skin_min_value", &skin_min_value, InRange(0, 255));
    a->Visit("skin_min_saturation", &skin_min_saturation, InRange(0, 255));
  }
  int hair_min_p{220};          ///< b = 1 where p exceeds it (Eq. 27)
  int skin_min_value{50};       ///< h = 0 on darker pixels: their hue is noise. 0: as printed
  int skin_min_saturation{30};  ///< h = 0 on paler pixels (255: pure colour). 0: as printed
};

/// One image as the fitness needs it: four bytes a pixel, fetched at once.
///
///   byte 0  b: 255 where the pixel is hair, Eq. 27, else 0
///   byte 1  h: 255 where it is skin, Eq. 26, else 0
///   byte 2  p for the features, byte 3 p for the site: 255 - grey, so 255 is black
///
/// A border of one pixel holds zeros: what a model point sees outside the image.
class PackedMap {
 public:
  /// Allocates for images of @p width x @p height px.
  PackedMap(int width, int height);

  /// Fills the map. @p image is kRgb, kBgr or kGray (b = h = 0) of the map's size; no allocation.
  void Build(const ImageView& image, const ColorRuleConfig& rule);

  /// All pixels zero.
  void Clear();

  int width() const { return width_; }
  int height() const { return height_; }
  bool has_color() const { return has_color_; }
  /// [pixels] from one row to the next.
  int stride() const { return width_ + 2; }
  /// The border's first pixel, at (-1, -1).
  const std::uint32_t* data() const { return pixels_.data(); }
  std::uint32_t at(int x, int y) const {
    return pixels_[static_cast<std::size_t>(y + 1) * static_cast<std::size_t>(stride()) +
                   static_cast<std::size_t>(x + 1)];
  }

 private:
  int width_, height_;
  bool has_color_{false};
  std::vector<std::uint32_t> pixels_;
};

}  // namespace visavis
