#pragma once

#include <cstdint>
#include <vector>

#include "common/image/image.h"

namespace visavis {

/// Brightness (0.299 red + 0.587 green + 0.114 blue) of a kRgb picture. @return a kGray view of
/// @p pixels, which are overwritten. @throws std::invalid_argument for another format.
ImageView ToGray(const ImageView& rgb, std::vector<std::uint8_t>* pixels);

}  // namespace visavis
