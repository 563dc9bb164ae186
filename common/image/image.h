#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace visavis {

enum class PixelFormat { kGray, kRgb, kBgr, kBayerBggr, kBayerGbrg, kBayerGrbg, kBayerRggb, kJpeg };

/// Lower-case name, e.g. "bayer_rggb".
std::string PixelFormatName(PixelFormat format);

/// Bytes a pixel of a raw format takes: 1 or 3; 0 for JPEG.
int BytesPerPixel(PixelFormat format);

/// Read-only picture in memory that somebody else owns. Rows from the top.
struct ImageView {
  const std::uint8_t* data{nullptr};
  int width{0}, height{0};  ///< [px]
  int stride{0};            ///< [bytes] from one row to the next; 0 for JPEG
  std::size_t size{0};      ///< [bytes] of data
  PixelFormat format{PixelFormat::kGray};

  const std::uint8_t* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
};

/// Where the channels of a pixel lie in a kRgb, kBgr or kGray picture [bytes]. A grey level is a
/// colour whose channels are equal.
struct Channels {
  explicit Channels(PixelFormat format)
      : step(BytesPerPixel(format)),
        red(format == PixelFormat::kBgr ? 2 : 0),
        green(step == 1 ? 0 : 1),
        blue(step == 1 ? 0 : 2 - red) {}
  int step;  ///< from one pixel to the next
  int red, green, blue;
};

}  // namespace visavis
