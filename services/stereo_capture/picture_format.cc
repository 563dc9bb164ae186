#include "services/stereo_capture/picture_format.h"

#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace visavis {

bool IsPictureFormat(const std::string& pixel_format) {
  return pixel_format == "keep" || pixel_format == "Mono8" || pixel_format == "RGB8" ||
         pixel_format == "BGR8";
}

CapturedFrame ToFrame(const cv::Mat& picture, const std::string& pixel_format, Side side) {
  if (picture.empty() || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)) {
    throw std::invalid_argument(std::string(SideName(side)) +
                                " picture: " + cv::typeToString(picture.type()) +
                                ": must be of 8 bits, grey or of three colours");
  }
  const bool is_gray = picture.channels() == 1;
  auto own = std::make_shared<cv::Mat>();
  PixelFormat format = is_gray ? PixelFormat::kGray : PixelFormat::kBgr;
  if (pixel_format == "Mono8" && !is_gray) {
    cv::cvtColor(picture, *own, cv::COLOR_BGR2GRAY);
    format = PixelFormat::kGray;
  } else if (pixel_format == "RGB8" || (pixel_format == "BGR8" && is_gray)) {
    const bool to_rgb = pixel_format == "RGB8";
    cv::cvtColor(picture, *own, is_gray ? cv::COLOR_GRAY2BGR : cv::COLOR_BGR2RGB);
    format = to_rgb ? PixelFormat::kRgb : PixelFormat::kBgr;
  } else {
    picture.copyTo(*own);
  }
  CapturedFrame frame;
  frame.side = side;
  frame.image = {own->data,
                 own->cols,
                 own->rows,
                 static_cast<int>(own->step),
                 own->step * static_cast<std::size_t>(own->rows),
                 format};
  frame.memory = own;
  return frame;
}

}  // namespace visavis
