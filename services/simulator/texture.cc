#include "services/simulator/texture.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "common/core/check.h"

namespace visavis {
namespace {

bool IsPowerOfTwo(int n) { return n > 0 && (n & (n - 1)) == 0; }

Texel Average(const std::array<Texel, 4>& from) {
  std::array<int, 8> sum{};
  std::array<int, kNumLabels> votes{};
  for (const Texel& texel : from) {
    std::array<std::uint8_t, 8> bytes;
    std::memcpy(bytes.data(), &texel, 8);
    for (std::size_t i = 0; i < 8; ++i) sum[i] += bytes[i];
    ++votes[static_cast<std::size_t>(texel.label)];
  }
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < 8; ++i) bytes[i] = static_cast<std::uint8_t>((sum[i] + 2) / 4);
  Texel result;
  std::memcpy(static_cast<void*>(&result), bytes.data(), 8);
  result.label = static_cast<Label>(std::max_element(votes.begin(), votes.end()) - votes.begin());
  return result;
}

// GCC's and Clang's portable vectors: eight bytes, and the same widened for weighting.
using Bytes = std::uint8_t __attribute__((vector_size(8)));
using Lanes = std::uint16_t __attribute__((vector_size(16)));

Lanes Load(const Texel* texel) {
  Bytes bytes;
  std::memcpy(&bytes, texel, 8);
  return __builtin_convertvector(bytes, Lanes);
}

}  // namespace

Texture::Texture(int width, int height) : width_(width), height_(height) {
  VISAVIS_THROW_UNLESS(IsPowerOfTwo(width) && width <= 8192, width);
  VISAVIS_THROW_UNLESS(IsPowerOfTwo(height) && height <= 8192, height);
  std::size_t total = 0;
  for (int w = width, h = height;; w = std::max(w / 2, 1), h = std::max(h / 2, 1)) {
    levels_.push_back({total, w, h});
    total += static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
    if (w == 1 && h == 1) break;
  }
  texels_.resize(total);
}

void Texture::BuildLevels() {
  for (std::size_t k = 1; k < levels_.size(); ++k) {
    const Level &fine = levels_[k - 1], &coarse = levels_[k];
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        const auto from = [&](int i, int j) {
          const int column = std::min(2 * x + i, fine.width - 1);
          const int row = std::min(2 * y + j, fine.height - 1);
          return texels_[fine.offset + static_cast<std::size_t>(row * fine.width + column)];
        };
        texels_[coarse.offset + static_cast<std::size_t>(y * coarse.width + x)] =
            Average({from(0, 0), from(1, 0), from(0, 1), from(1, 1)});
      }
    }
  }
}

Texture::Tap Texture::Locate(float u, float v, int level) const {
  const Level& l =
      levels_[static_cast<std::size_t>(std::clamp(level, 0, static_cast<int>(levels_.size()) - 1))];
  // Fixed point, 1/256 texel; texel centres at half-integers.
  const float x = std::clamp(u, 0.0f, 1.0f) * static_cast<float>(l.width) * 256.0f;
  const float y = std::clamp(v, 0.0f, 1.0f) * static_cast<float>(l.height) * 256.0f;
  const int fx = std::max(static_cast<int>(x) - 128, 0);
  const int fy = std::max(static_cast<int>(y) - 128, 0);
  const int x0 = std::min(fx >> 8, l.width - 1), y0 = std::min(fy >> 8, l.height - 1);
  const std::uint32_t a = fx & 255, b = fy & 255;
  const std::uint32_t w11 = (a * b) >> 8, w10 = a - w11, w01 = b - w11, w00 = 256 - a - b + w11;
  return {texels_.data() + l.offset + static_cast<std::size_t>(y0 * l.width + x0),
          x0 + 1 < l.width ? 1 : 0,
          y0 + 1 < l.height ? l.width : 0,
          {static_cast<std::uint16_t>(w00), static_cast<std::uint16_t>(w10),
           static_cast<std::uint16_t>(w01), static_cast<std::uint16_t>(w11)}};
}

Texel Texture::Fetch(const Tap& tap) {
  // Eight bytes are mixed at once, in 16-bit lanes.
  const Lanes sum = Load(tap.corner) * tap.weights[0] +
                    Load(tap.corner + tap.right) * tap.weights[1] +
                    Load(tap.corner + tap.down) * tap.weights[2] +
                    Load(tap.corner + tap.down + tap.right) * tap.weights[3];
  const Bytes mixed = __builtin_convertvector(sum >> 8, Bytes);
  Texel result;
  std::memcpy(static_cast<void*>(&result), &mixed, 8);
  const int to_right = tap.weights[1] + tap.weights[3], to_bottom = tap.weights[2] + tap.weights[3];
  result.label =
      tap.corner[(to_right >= 128 ? tap.right : 0) + (to_bottom >= 128 ? tap.down : 0)].label;
  return result;
}

}  // namespace visavis
