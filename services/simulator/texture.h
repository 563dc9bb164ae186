#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/mesh/label.h"

namespace visavis {

/// One texel, bytes as they are filtered.
struct Texel {
  std::uint8_t red{0}, green{0}, blue{0};  ///< albedo as 255 sqrt(linear reflectance)
  std::uint8_t gloss{0};                   ///< strength of the specular reflection, 255 = 1
  std::uint8_t dx{128}, dy{128}, dz{128};  ///< added to the unit normal: (d - 128) / 64
  Label label{Label::kBackground};
};
static_assert(sizeof(Texel) == 8);

/// A texture with its chain of halved levels.
class Texture {
 public:
  /// @throws std::invalid_argument unless both are powers of two in 1 .. 8192.
  Texture(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Texel of the finest level; column and row in range.
  Texel& at(int column, int row) {
    return texels_[static_cast<std::size_t>(row * width_ + column)];
  }
  const Texel& at(int column, int row) const {
    return texels_[static_cast<std::size_t>(row * width_ + column)];
  }

  /// Computes the coarser levels: colours and normals averaged, labels by majority.
  void BuildLevels();

  /// Four neighbouring texels and their weights, of sum 256: top left, top right, bottom left,
  /// bottom right.
  struct Tap {
    const Texel* corner;
    int right, down;  ///< distances from the corner; 0 at the texture's edge
    std::array<std::uint16_t, 4> weights;
  };

  /// The texels round (u, v) in [0, 1] of @p level (clamped to those that exist; edges repeat).
  Tap Locate(float u, float v, int level) const;

  /// Asks the processor to fetch them.
  static void Prefetch(const Tap& tap) {
    __builtin_prefetch(tap.corner);
    __builtin_prefetch(tap.corner + tap.down);
  }

  /// Bilinear mean of the four; the label is that of the heaviest.
  static Texel Fetch(const Tap& tap);

  int num_levels() const { return static_cast<int>(levels_.size()); }

 private:
  struct Level {
    std::size_t offset;
    int width, height;
  };
  int width_, height_;
  std::vector<Texel> texels_;
  std::vector<Level> levels_;
};

}  // namespace visavis
