#pragma once

#include <cstdint>

namespace visavis {

/// Thresholds of Eqs. 26 and 27 as the kernel takes them; see ColorRuleConfig.
struct PackRule {
  std::uint8_t hair_min_p, skin_min_value, skin_min_saturation;
  bool bgr;  ///< the first byte of a pixel is blue
};

/// Pixels behind the map that the kernels may write to (the rest of a last vector).
inline constexpr int kMapPadding = 64;

/// Packs @p n pixels of 3 bytes into b, h, p, p (see PackedMap). The same bytes on every SIMD
/// target.
void PackColorRow(const std::uint8_t* pixels, int n, const PackRule& rule, std::uint32_t* out);

/// Packs @p n grey pixels into 0, 0, p, p.
void PackGrayRow(const std::uint8_t* pixels, int n, std::uint32_t* out);

}  // namespace visavis
