#include "common/image/remap.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/core/check.h"

namespace visavis {

ImageRemap::ImageRemap(int width, int height, const std::function<Source(int x, int y)>& source_of)
    : width_(width), height_(height) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<float> xy(2 * pixels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Source source = source_of(x, y);
      const std::size_t at =
          2 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + x);
      xy[at] = static_cast<float>(source.x);
      xy[at + 1] = static_cast<float>(source.y);
    }
  }
  fixed_.resize(2 * pixels);
  weights_.resize(pixels);
  const cv::Mat table(height, width, CV_32FC2, xy.data());
  cv::Mat fixed(height, width, CV_16SC2, fixed_.data()),
      weights(height, width, CV_16UC1, weights_.data());
  cv::convertMaps(table, cv::noArray(), fixed, weights, CV_16SC2);
}

ImageView ImageRemap::Apply(const ImageView& image) {
  VISAVIS_THROW_UNLESS(image.width == width_ && image.height == height_, image.width);
  const int bytes = BytesPerPixel(image.format);
  VISAVIS_THROW_UNLESS(bytes == 3 || image.format == PixelFormat::kGray,
                       PixelFormatName(image.format));
  pixels_.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                 static_cast<std::size_t>(bytes));
  const int type = bytes == 3 ? CV_8UC3 : CV_8UC1;
  const cv::Mat source(height_, width_, type, const_cast<std::uint8_t*>(image.data),
                       static_cast<std::size_t>(image.stride));
  const cv::Mat fixed(height_, width_, CV_16SC2, fixed_.data());
  const cv::Mat weights(height_, width_, CV_16UC1, weights_.data());
  cv::Mat result(height_, width_, type, pixels_.data());
  cv::remap(source, result, fixed, weights, cv::INTER_LINEAR, cv::BORDER_CONSTANT,
            cv::Scalar::all(255));
  return {pixels_.data(), width_, height_, width_ * bytes, pixels_.size(), image.format};
}

}  // namespace visavis
