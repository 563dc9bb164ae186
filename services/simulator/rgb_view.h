#pragma once

#include <cstddef>
#include <cstdint>

namespace visavis {

/// RGB pixels of somebody else to be written, rows from the top.
struct RgbView {
  std::uint8_t* data;
  int width, height;  ///< [px]
  int stride;         ///< [bytes] from one row to the next, >= 3 width

  std::uint8_t* row(int y) const { return data + static_cast<std::ptrdiff_t>(y) * stride; }
};

}  // namespace visavis
