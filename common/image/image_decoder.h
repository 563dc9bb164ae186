#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.h"

namespace visavis {

/// Turns any format into RGB or grey, in memory of its own that is reused from picture to picture.
class ImageDecoder {
 public:
  ImageDecoder();
  ~ImageDecoder();
  ImageDecoder(const ImageDecoder&) = delete;
  ImageDecoder& operator=(const ImageDecoder&) = delete;

  /// @return a view of @p image as kRgb, kBgr or kGray: the same memory where it is one of these
  /// already, else decoded memory that is valid until the next call.
  /// @throws std::invalid_argument for a JPEG that is damaged, or whose size is not
  /// image.width x image.height.
  ImageView Decode(const ImageView& image);

 private:
  ImageView DecodeJpeg(const ImageView& image);
  ImageView DecodeBayer(const ImageView& image);
  std::uint8_t* Reserve(int width, int height, int bytes_per_pixel);

  void* jpeg_;  // tjhandle
  std::vector<std::uint8_t> buffer_;
};

/// Compresses RGB, BGR or grey pictures to JPEG, in memory of its own.
class JpegEncoder {
 public:
  JpegEncoder();
  ~JpegEncoder();
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;

  /// @param quality 1 to 100. @return a kJpeg view, valid until the next call.
  ImageView Encode(const ImageView& image, int quality);

 private:
  void* jpeg_;  // tjhandle
  std::vector<std::uint8_t> buffer_;
};

}  // namespace visavis
