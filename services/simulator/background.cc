#include "services/simulator/background.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "common/core/check.h"
#include "services/simulator/room_painter.h"

namespace visavis {
namespace {

constexpr int kWidth = 2048, kHeight = 1024, kStride = kWidth + 1;
constexpr float kPixelPerM = 400;

using Bytes = std::uint8_t __attribute__((vector_size(8)));
using Lanes = std::uint16_t __attribute__((vector_size(16)));

/// Two neighbouring pixels, widened for weighting.
Lanes LoadPair(const std::uint32_t* pixel) {
  Bytes bytes;
  std::memcpy(&bytes, pixel, 8);
  return __builtin_convertvector(bytes, Lanes);
}

}  // namespace

void BackgroundConfig::ValidateOrThrow() const {
  VISAVIS_THROW_UNLESS(wall_z_m >= 1.4 && wall_z_m <= 10, wall_z_m);
  VISAVIS_THROW_UNLESS((skin.array() >= 0).all() && (skin.array() <= 1).all(), skin.transpose());
}

Background::Background(const BackgroundConfig& config, std::uint64_t seed)
    : wall_z_(static_cast<float>(config.wall_z_m)),
      picture_(static_cast<std::size_t>(kStride) * (kHeight + 1)) {
  config.ValidateOrThrow();
  const int shrink = config.coarse ? 4 : 1, width = kWidth / shrink;
  RoomPainter painter(width, kHeight / shrink, shrink / static_cast<double>(kPixelPerM), seed);
  painter.PaintRoom(config.skin_coloured ? config.skin : Srgb(0.74, 0.745, 0.73));
  const std::vector<std::uint32_t> painted = painter.TakePicture();
  for (int y = 0; y <= kHeight; ++y) {
    const std::uint32_t* from =
        painted.data() + static_cast<std::ptrdiff_t>(y % kHeight / shrink) * width;
    std::uint32_t* to = picture_.data() + static_cast<std::ptrdiff_t>(y) * kStride;
    for (int x = 0; x < kWidth; ++x) to[x] = from[x / shrink];
    to[kWidth] = from[0];
  }
}

std::uint32_t Background::Bilinear(int fx, int fy) const {
  static_assert((kWidth & (kWidth - 1)) == 0 && (kHeight & (kHeight - 1)) == 0);
  const int x0 = (fx >> 8) & (kWidth - 1), y0 = (fy >> 8) & (kHeight - 1);
  const auto a = static_cast<std::uint16_t>(fx & 255), b = static_cast<std::uint16_t>(fy & 255);
  const auto c = static_cast<std::uint16_t>(256 - a), d = static_cast<std::uint16_t>(256 - b);
  const std::uint32_t* pixel = picture_.data() + static_cast<std::ptrdiff_t>(y0) * kStride + x0;
  const Lanes column = (LoadPair(pixel) * d + LoadPair(pixel + kStride) * b) >> 8;
  const Lanes weighted = column * Lanes{c, c, c, c, a, a, a, a};
  std::uint64_t halves[2];
  std::memcpy(halves, &weighted, 16);
  std::uint64_t sum = ((halves[0] + halves[1]) >> 8) & 0x00ff00ff00ff00ffull;
  sum = (sum | sum >> 8) & 0x0000ffff0000ffffull;
  return static_cast<std::uint32_t>(sum | sum >> 16);
}

[[gnu::target_clones("avx2", "default")]] void Background::Sample(const Eigen::Vector3f& p_SC,
                                                                  const Eigen::Matrix3f& R_SC,
                                                                  const float* x, const float* y,
                                                                  std::uint32_t* rgb) const {
  // Coordinates from the wall's middle in 1/256 pixel; eight pictures' widths keep them positive,
  // where truncation is rounding down.
  constexpr float kLimit = 8.0f * 256 * kHeight, kScale = 256 * kPixelPerM;
  constexpr float kMiddleX = (8 * kWidth + kWidth / 2) * 256.0f,
                  kMiddleY = (8 * kHeight + kHeight / 2) * 256.0f;
  const float r00 = R_SC(0, 0), r01 = R_SC(0, 1), r02 = R_SC(0, 2), r10 = R_SC(1, 0),
              r11 = R_SC(1, 1), r12 = R_SC(1, 2), r20 = R_SC(2, 0), r21 = R_SC(2, 1),
              r22 = R_SC(2, 2);
  const float px = p_SC.x(), py = p_SC.y(), depth = wall_z_ - p_SC.z();
  std::array<int, kRun> fx, fy;
  for (std::size_t i = 0; i < kRun; ++i) {
    const float s = depth / std::max(r20 * x[i] + r21 * y[i] + r22, 0.05f);
    const float wall_x = kScale * (px + s * (r00 * x[i] + r01 * y[i] + r02));
    const float wall_y = kScale * (py + s * (r10 * x[i] + r11 * y[i] + r12));
    fx[i] = static_cast<int>(std::min(std::max(wall_x, -kLimit), kLimit) + kMiddleX);
    fy[i] = static_cast<int>(std::min(std::max(wall_y, -kLimit), kLimit) + kMiddleY);
  }
  for (std::size_t i = 0; i < kRun; ++i) rgb[i] = Bilinear(fx[i], fy[i]);
}

}  // namespace visavis
