#include "common/image/image.h"

namespace visavis {

std::string PixelFormatName(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray:
      return "gray";
    case PixelFormat::kRgb:
      return "rgb";
    case PixelFormat::kBgr:
      return "bgr";
    case PixelFormat::kBayerBggr:
      return "bayer_bggr";
    case PixelFormat::kBayerGbrg:
      return "bayer_gbrg";
    case PixelFormat::kBayerGrbg:
      return "bayer_grbg";
    case PixelFormat::kBayerRggb:
      return "bayer_rggb";
    case PixelFormat::kJpeg:
      return "jpeg";
  }
  return "unknown";
}

int BytesPerPixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb:
    case PixelFormat::kBgr:
      return 3;
    case PixelFormat::kJpeg:
      return 0;
    default:
      return 1;
  }
}

}  // namespace visavis
