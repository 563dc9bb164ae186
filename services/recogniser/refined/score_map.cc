#include "services/recogniser/refined/score_map.h"

#include "common/core/check.h"
#include "services/recogniser/refined/picture_kernel.h"

namespace visavis {

void ScoreMap::Build(const ImageView& image, const ColorModel& model, const PixelBox& box) {
  VISAVIS_THROW_UNLESS(image.width <= width_ && image.height <= height_, image.width);
  VISAVIS_THROW_UNLESS(box.x0 >= 0 && box.y0 >= 0 && box.x1 <= image.width, box.x1);
  VISAVIS_THROW_UNLESS(box.y1 <= image.height, box.y1);
  box_ = box;
  has_color_ = image.format != PixelFormat::kGray;
  if (!has_color_) {
    box_ = {};
    return;
  }
  const bool bgr = image.format == PixelFormat::kBgr;
  for (int y = box.y0; y < box.y1; ++y) {
    LookUpScores(image.row(y) + 3 * std::ptrdiff_t{box.x0}, box.width(), bgr, model.table().data(),
                 scores_.data() + Index(box.x0, y));
  }
}

}  // namespace visavis
