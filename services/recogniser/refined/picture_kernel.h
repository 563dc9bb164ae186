#pragma once

#include <cstdint>

namespace visavis {

/// Looks the colours of @p n pixels of 3 bytes up in a ColorModel's table.
void LookUpScores(const std::uint8_t* pixels, int n, bool bgr, const std::uint32_t* table,
                  std::uint32_t* scores);

/// Brightness of @p n pixels of 3 bytes, the mean of two rows' pixels, in units of 1/256 level.
void MeanBrightness(const std::uint8_t* top, const std::uint8_t* bottom, int n, bool bgr,
                    std::uint16_t* out);

/// Shares of @p n colours in skin, hair and surroundings, none 0.
struct ColorShares {
  const float *skin, *hair, *surroundings;
};
/// The PackedScores of @p n colours, a multiple of 16, of those shares. The same bits on every SIMD
/// target; logarithms to 0.0005.
void MakeScores(const ColorShares& shares, int n, std::uint32_t* scores);

}  // namespace visavis
