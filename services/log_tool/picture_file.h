#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "common/image/image_decoder.h"

namespace visavis {

/// Reads pictures as a log holds them: a JPEG file stays its bytes, anything else (PNG, PNM, BMP,
/// TIFF ...) becomes raw RGB, or grey where it is grey; transparency is dropped.
class PictureReader {
 public:
  /// @return a view that is valid until the next call. A file read twice in a row is read once.
  /// @throws std::invalid_argument "RULE, VALUE" unless it is an undamaged picture of 8 bits a
  /// channel and of @p width x @p height.
  const ImageView& Read(const std::string& path, int width, int height);

 private:
  ImageView ReadAnew(const std::string& path);

  std::string path_;  ///< empty: nothing is held
  ImageView image_;
  std::vector<std::uint8_t> file_;
  std::vector<std::uint8_t> pixels_;
  ImageDecoder decoder_;
};

/// Writes @p image to @p stem with the extension that fits: JPEG bytes to .jpg as they are, others
/// to .png without loss (a Bayer pattern as the RGB picture made of it).
/// @return the extension. @throws std::runtime_error naming the file that cannot be written,
/// std::invalid_argument where the image cannot be decoded.
std::string WritePicture(const ImageView& image, const std::string& stem, ImageDecoder* decoder);

}  // namespace visavis
