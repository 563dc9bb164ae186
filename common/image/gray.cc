#include "common/image/gray.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "common/core/check.h"

namespace visavis {

ImageView ToGray(const ImageView& rgb, std::vector<std::uint8_t>* pixels) {
  VISAVIS_THROW_UNLESS(rgb.format == PixelFormat::kRgb, PixelFormatName(rgb.format));
  pixels->resize(static_cast<std::size_t>(rgb.width) * static_cast<std::size_t>(rgb.height));
  // OpenCV takes no const pictures; it only reads this one.
  const cv::Mat from(rgb.height, rgb.width, CV_8UC3,
                     const_cast<std::uint8_t*>(rgb.data),  // NOLINT
                     static_cast<std::size_t>(rgb.stride));
  cv::Mat to(rgb.height, rgb.width, CV_8UC1, pixels->data());
  cv::cvtColor(from, to, cv::COLOR_RGB2GRAY);
  return {pixels->data(), rgb.width, rgb.height, rgb.width, pixels->size(), PixelFormat::kGray};
}

}  // namespace visavis
