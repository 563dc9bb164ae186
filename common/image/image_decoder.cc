#include "common/image/image_decoder.h"

#include <turbojpeg.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "common/core/check.h"

namespace visavis {
namespace {

// OpenCV names a Bayer pattern by the pixels at (1, 1) and (1, 2), we by those at (0, 0), (0, 1).
int BayerConversion(PixelFormat format) {
  switch (format) {
    case PixelFormat::kBayerRggb:
      return cv::COLOR_BayerBG2RGB;
    case PixelFormat::kBayerBggr:
      return cv::COLOR_BayerRG2RGB;
    case PixelFormat::kBayerGbrg:
      return cv::COLOR_BayerGR2RGB;
    default:
      return cv::COLOR_BayerGB2RGB;
  }
}

int TurboFormat(PixelFormat format) {
  if (format == PixelFormat::kGray) return TJPF_GRAY;
  return format == PixelFormat::kRgb ? TJPF_RGB : TJPF_BGR;
}

}  // namespace

ImageDecoder::ImageDecoder() : jpeg_(tjInitDecompress()) {
  if (!jpeg_) throw std::runtime_error("cannot start the JPEG decoder");
}

ImageDecoder::~ImageDecoder() { tjDestroy(jpeg_); }

ImageView ImageDecoder::Decode(const ImageView& image) {
  switch (image.format) {
    case PixelFormat::kGray:
    case PixelFormat::kRgb:
    case PixelFormat::kBgr:
      return image;
    case PixelFormat::kJpeg:
      return DecodeJpeg(image);
    default:
      return DecodeBayer(image);
  }
}

std::uint8_t* ImageDecoder::Reserve(int width, int height, int bytes_per_pixel) {
  buffer_.resize(static_cast<std::size_t>(width) * height * bytes_per_pixel);
  return buffer_.data();
}

ImageView ImageDecoder::DecodeJpeg(const ImageView& image) {
  int width = 0, height = 0, subsampling = 0, colorspace = 0;
  if (tjDecompressHeader3(jpeg_, image.data, image.size, &width, &height, &subsampling,
                          &colorspace) != 0) {
    throw std::invalid_argument(std::string("image: is no JPEG: ") + tjGetErrorStr2(jpeg_));
  }
  if (width != image.width || height != image.height) {
    throw std::invalid_argument(
        "image: JPEG of " + std::to_string(width) + "x" + std::to_string(height) + ": must be " +
        std::to_string(image.width) + "x" + std::to_string(image.height) + " as its message says");
  }
  const bool gray = colorspace == TJCS_GRAY;
  const int bytes = gray ? 1 : 3;
  std::uint8_t* pixels = Reserve(width, height, bytes);
  if (tjDecompress2(jpeg_, image.data, image.size, pixels, width, width * bytes, height,
                    gray ? TJPF_GRAY : TJPF_RGB, TJFLAG_ACCURATEDCT | TJFLAG_STOPONWARNING) != 0) {
    throw std::invalid_argument(std::string("image: damaged JPEG: ") + tjGetErrorStr2(jpeg_));
  }
  return {pixels,        width,          height,
          width * bytes, buffer_.size(), gray ? PixelFormat::kGray : PixelFormat::kRgb};
}

ImageView ImageDecoder::DecodeBayer(const ImageView& image) {
  VISAVIS_THROW_UNLESS(image.width >= 2 && image.height >= 2, image.width);
  std::uint8_t* pixels = Reserve(image.width, image.height, 3);
  const cv::Mat bayer(image.height, image.width, CV_8UC1, const_cast<std::uint8_t*>(image.data),
                      static_cast<std::size_t>(image.stride));
  cv::Mat rgb(image.height, image.width, CV_8UC3, pixels);
  cv::cvtColor(bayer, rgb, BayerConversion(image.format));
  return {pixels, image.width, image.height, image.width * 3, buffer_.size(), PixelFormat::kRgb};
}

JpegEncoder::JpegEncoder() : jpeg_(tjInitCompress()) {
  if (!jpeg_) throw std::runtime_error("cannot start the JPEG encoder");
}

JpegEncoder::~JpegEncoder() { tjDestroy(jpeg_); }

ImageView JpegEncoder::Encode(const ImageView& image, int quality) {
  VISAVIS_THROW_UNLESS(quality >= 1 && quality <= 100, quality);
  VISAVIS_THROW_UNLESS(image.format == PixelFormat::kGray || BytesPerPixel(image.format) == 3,
                       PixelFormatName(image.format));
  const int subsampling = image.format == PixelFormat::kGray ? TJSAMP_GRAY : TJSAMP_422;
  buffer_.resize(tjBufSize(image.width, image.height, subsampling));
  unsigned char* out = buffer_.data();
  unsigned long size = buffer_.size();
  if (tjCompress2(jpeg_, image.data, image.width, image.stride, image.height,
                  TurboFormat(image.format), &out, &size, subsampling, quality,
                  TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0) {
    throw std::runtime_error(std::string("cannot encode JPEG: ") + tjGetErrorStr2(jpeg_));
  }
  return {out, image.width, image.height, 0, size, PixelFormat::kJpeg};
}

}  // namespace visavis
