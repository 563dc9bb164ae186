#include "services/recogniser/packed_map.h"

#include <algorithm>

#include "common/core/check.h"
#include "services/recogniser/packed_map_kernel.h"

namespace visavis {

PackedMap::PackedMap(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width + 2) * (height + 2) + kMapPadding, 0) {
  VISAVIS_THROW_UNLESS(width > 0 && width <= 16384, width);
  VISAVIS_THROW_UNLESS(height > 0 && height <= 16384, height);
}

void PackedMap::Build(const ImageView& image, const ColorRuleConfig& rule) {
  VISAVIS_THROW_UNLESS(image.width == width_ && image.height == height_, image.width);
  VISAVIS_THROW_UNLESS(image.format == PixelFormat::kGray || BytesPerPixel(image.format) == 3,
                       PixelFormatName(image.format));
  has_color_ = image.format != PixelFormat::kGray;
  const PackRule pack{
      static_cast<std::uint8_t>(rule.hair_min_p), static_cast<std::uint8_t>(rule.skin_min_value),
      static_cast<std::uint8_t>(rule.skin_min_saturation), image.format == PixelFormat::kBgr};
  for (int y = 0; y < height_; ++y) {
    std::uint32_t* out = pixels_.data() + static_cast<std::size_t>(y + 1) * stride() + 1;
    if (has_color_) {
      PackColorRow(image.row(y), width_, pack, out);
    } else {
      PackGrayRow(image.row(y), width_, out);
    }
  }
}

void PackedMap::Clear() { std::fill(pixels_.begin(), pixels_.end(), 0); }

}  // namespace visavis
