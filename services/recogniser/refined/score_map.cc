#include "services/recogniser/refined/score_map.h"

#include "common/core/check.h"

namespace visavis {

void ScoreMap::Build(const ImageView& image, const ColorModel& model, const PixelBox& box) {
  VISAVIS_THROW_UNLESS(image.width == width_ && image.height == height_, image.width);
  VISAVIS_THROW_UNLESS(box.x0 >= 0 && box.y0 >= 0 && box.x1 <= width_ && box.y1 <= height_, box.x1);
  box_ = box;
  has_color_ = image.format != PixelFormat::kGray;
  if (!has_color_) {
    box_ = {};
    return;
  }
  const int red = image.format == PixelFormat::kBgr ? 2 : 0;
  const PackedScores* table = model.table().data();
  for (int y = box.y0; y < box.y1; ++y) {
    const std::uint8_t* p = image.row(y) + 3 * std::ptrdiff_t{box.x0};
    PackedScores* out = scores_.data() + static_cast<std::ptrdiff_t>(y) * width_;
    for (int x = box.x0; x < box.x1; ++x, p += 3) {
      out[x] = table[ColorModel::BinOf(p[red], p[1], p[2 - red])];
    }
  }
}

}  // namespace visavis
