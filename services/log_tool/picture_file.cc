#include "services/log_tool/picture_file.h"

#include <turbojpeg.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace visavis {
namespace {

bool IsJpeg(const std::vector<std::uint8_t>& file) {
  return file.size() > 3 && file[0] == 0xFF && file[1] == 0xD8 && file[2] == 0xFF;
}

/// A JPEG's view with the size in its header; 0 x 0 where there is none.
ImageView JpegView(const std::vector<std::uint8_t>& file) {
  ImageView view{file.data(), 0, 0, 0, file.size(), PixelFormat::kJpeg};
  int subsampling = 0, colorspace = 0;
  const tjhandle handle = tjInitDecompress();
  if (tjDecompressHeader3(handle, file.data(), file.size(), &view.width, &view.height, &subsampling,
                          &colorspace) != 0) {
    view.width = view.height = 0;
  }
  tjDestroy(handle);
  return view;
}

void WriteFile(const std::string& path, const std::uint8_t* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  file.close();
  if (!file) throw std::runtime_error(path + ": " + std::strerror(errno));
}

}  // namespace

const ImageView& PictureReader::Read(const std::string& path, int width, int height) {
  if (path != path_) {
    path_.clear();
    image_ = ReadAnew(path);
    path_ = path;
  }
  if (image_.width != width || image_.height != height) {
    throw std::invalid_argument("must be " + std::to_string(width) + "x" + std::to_string(height) +
                                " px as in rig.yaml, is " + std::to_string(image_.width) + "x" +
                                std::to_string(image_.height));
  }
  return image_;
}

ImageView PictureReader::ReadAnew(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  file_.assign(std::istreambuf_iterator<char>(file), {});
  if (IsJpeg(file_)) {
    const ImageView jpeg = JpegView(file_);
    try {
      decoder_.Decode(jpeg);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(std::string("must be an undamaged picture, ") + e.what());
    }
    return jpeg;
  }
  cv::Mat picture;
  try {
    if (!file_.empty()) picture = cv::imdecode(file_, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    // Left empty.
  }
  if (picture.empty()) throw std::invalid_argument("must be an undamaged picture, is none");
  const int channels = picture.channels();
  if (picture.depth() != CV_8U || (channels != 1 && channels != 3 && channels != 4)) {
    throw std::invalid_argument("must have 8 bits a channel, grey or colour");
  }
  const int bytes = channels == 1 ? 1 : 3;
  pixels_.resize(static_cast<std::size_t>(picture.cols) * picture.rows * bytes);
  cv::Mat pixels(picture.rows, picture.cols, bytes == 1 ? CV_8UC1 : CV_8UC3, pixels_.data());
  if (channels == 1) {
    picture.copyTo(pixels);
  } else {
    cv::cvtColor(picture, pixels, channels == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_BGRA2RGB);
  }
  return {pixels_.data(), picture.cols,
          picture.rows,   picture.cols * bytes,
          pixels_.size(), bytes == 1 ? PixelFormat::kGray : PixelFormat::kRgb};
}

std::string WritePicture(const ImageView& image, const std::string& stem, ImageDecoder* decoder) {
  if (image.format == PixelFormat::kJpeg) {
    WriteFile(stem + ".jpg", image.data, image.size);
    return ".jpg";
  }
  const ImageView raw = decoder->Decode(image);
  cv::Mat pixels(raw.height, raw.width, raw.format == PixelFormat::kGray ? CV_8UC1 : CV_8UC3,
                 const_cast<std::uint8_t*>(raw.data), static_cast<std::size_t>(raw.stride));
  if (raw.format == PixelFormat::kRgb) {
    cv::Mat bgr;
    cv::cvtColor(pixels, bgr, cv::COLOR_RGB2BGR);
    pixels = bgr;
  }
  std::vector<std::uint8_t> png;
  cv::imencode(".png", pixels, png, {cv::IMWRITE_PNG_COMPRESSION, 3});
  WriteFile(stem + ".png", png.data(), png.size());
  return ".png";
}

}  // namespace visavis
