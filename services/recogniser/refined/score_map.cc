#include "services/recogniser/refined/score_map.h"

#include <array>

#include "common/core/check.h"
#include "services/recogniser/refined/picture_kernel.h"

namespace visavis {

void ScoreMap::Build(const ImageView& image, const ColorModel& model, const PixelBox& box) {
  VISAVIS_THROW_UNLESS(image.width <= width_ && image.height <= height_, image.width);
  VISAVIS_THROW_UNLESS(box.x0 >= 0 && box.y0 >= 0 && box.x1 <= image.width, box.x1);
  VISAVIS_THROW_UNLESS(box.y1 <= image.height, box.y1);
  box_ = box;
  if (image.format == PixelFormat::kGray) {
    FillFromGray(image, model);
    return;
  }
  const bool bgr = image.format == PixelFormat::kBgr;
  for (int y = box.y0; y < box.y1; ++y) {
    LookUpScores(image.row(y) + 3 * std::ptrdiff_t{box.x0}, box.width(), bgr, model.table().data(),
                 scores_.data() + Index(box.x0, y));
  }
}

void ScoreMap::FillFromGray(const ImageView& image, const ColorModel& model) {
  std::array<PackedScores, 256> scores{};
  for (int level = 0; level < 256; ++level) {
    const int bin = ColorModel::BinOf(level, level, level);
    scores[static_cast<std::size_t>(level)] = model.table()[static_cast<std::size_t>(bin)];
  }
  for (int y = box_.y0; y < box_.y1; ++y) {
    const std::uint8_t* row = image.row(y);
    PackedScores* out = scores_.data() + Index(0, y);
    for (int x = box_.x0; x < box_.x1; ++x) out[x] = scores[row[x]];
  }
}

}  // namespace visavis
