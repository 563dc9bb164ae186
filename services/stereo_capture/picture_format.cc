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
  CapturedFrame frame;
  frame.side = side;
  frame.image.format = is_gray ? PixelFormat::kGray : PixelFormat::kBgr;
  if (pixel_format == "Mono8") frame.image.format = PixelFormat::kGray;
  if (pixel_format == "RGB8") frame.image.format = PixelFormat::kRgb;
  if (pixel_format == "BGR8") frame.image.format = PixelFormat::kBgr;
  frame.image.width = picture.cols;
  frame.image.height = picture.rows;
  frame.image.stride = picture.cols * BytesPerPixel(frame.image.format);
  frame.image.size = static_cast<std::size_t>(frame.image.stride) * picture.rows;
  frame.pixels = std::make_shared<std::vector<std::uint8_t>>(frame.image.size);
  frame.image.data = frame.pixels->data();
  cv::Mat own(picture.rows, picture.cols, CV_8UC(BytesPerPixel(frame.image.format)),
              frame.pixels->data());
  if (is_gray && own.channels() == 3) {
    cv::cvtColor(picture, own, cv::COLOR_GRAY2BGR);
  } else if (frame.image.format == PixelFormat::kRgb) {
    cv::cvtColor(picture, own, cv::COLOR_BGR2RGB);
  } else if (!is_gray && own.channels() == 1) {
    cv::cvtColor(picture, own, cv::COLOR_BGR2GRAY);
  } else {
    picture.copyTo(own);
  }
  return frame;
}

}  // namespace visavis
