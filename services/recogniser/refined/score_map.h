#pragma once

#include <cstddef>
#include <vector>

#include "common/image/image.h"
#include "services/recogniser/refined/color_model.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/score_kernel.h"

namespace visavis {

/// PackedScores of every pixel within a box of a picture.
class ScoreMap {
 public:
  /// Allocates for pictures of up to @p width x @p height px.
  ScoreMap(int width, int height)
      : width_(width),
        height_(height),
        scores_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}

  /// Fills @p box from a kRgb, kBgr or kGray picture. What was filled before becomes unknown.
  void Build(const ImageView& image, const ColorModel& model, const PixelBox& box);

  /// The nearest pixel's scores; unknown and neutral outside of the box.
  PackedScores At(float u, float v) const {
    const float x = u + 0.5f, y = v + 0.5f;
    if (!(x >= static_cast<float>(box_.x0) && y >= static_cast<float>(box_.y0) &&
          x < static_cast<float>(box_.x1) && y < static_cast<float>(box_.y1))) {
      return kUnknown;
    }
    return scores_[Index(static_cast<int>(x), static_cast<int>(y))];
  }
  /// As the kernels take it.
  ScoreView view() const {
    return {scores_.data(),
            width_,
            static_cast<float>(box_.x0),
            static_cast<float>(box_.y0),
            static_cast<float>(box_.x1),
            static_cast<float>(box_.y1)};
  }
  const PixelBox& box() const { return box_; }

  static constexpr PackedScores kUnknown = 0x00808080u;

 private:
  void FillFromGray(const ImageView& image, const ColorModel& model);
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }

  int width_, height_;
  PixelBox box_;
  std::vector<PackedScores> scores_;
};

}  // namespace visavis
