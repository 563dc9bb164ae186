#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/image/image.h"

namespace visavis {

/// Resamples pictures by a fixed table, bilinearly, in memory of its own.
class ImageRemap {
 public:
  /// Where in the source [px] pixel (x, y) of the result lies.
  struct Source {
    double x, y;
  };

  /// Tables for pictures of @p width x @p height px.
  ImageRemap(int width, int height, const std::function<Source(int x, int y)>& source_of);

  /// @param image kRgb, kBgr or kGray of the table's size. @return a view that is valid until the
  /// next call; what lies outside the source is white: black would be hair.
  ImageView Apply(const ImageView& image);

 private:
  int width_, height_;
  std::vector<std::int16_t> fixed_;     // whole pixels, x and y, as OpenCV takes them
  std::vector<std::uint16_t> weights_;  // the fractions
  std::vector<std::uint8_t> pixels_;
};

}  // namespace visavis
