#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/image/image.h"

namespace visavis {

/// What a pixel can belong to.
enum ColorClass : std::size_t { kSkinColor, kHairColor, kSurroundings };
inline constexpr std::size_t kNumColorClasses = 3;

/// A pixel's log-likelihood ratios against the surroundings, four bytes:
///   byte 0 hair, byte 1 skin, byte 2 any part of a head; 128 + kScorePerNat ln(ratio), clamped.
///   byte 3 is 255 where the pixel is known, 0 where it is not.
using PackedScores = std::uint32_t;
inline constexpr int kScoreZero = 128;
inline constexpr float kScorePerNat = 20;

inline int HairScore(PackedScores s) { return static_cast<int>(s & 255) - kScoreZero; }
inline int SkinScore(PackedScores s) { return static_cast<int>(s >> 8 & 255) - kScoreZero; }
inline int HeadScore(PackedScores s) { return static_cast<int>(s >> 16 & 255) - kScoreZero; }
inline bool IsKnown(PackedScores s) { return (s >> 24) != 0; }

/// How skin, hair and surroundings look to one camera: histograms of 16 x 16 x 16 colours, first
/// from a prior, then from what good poses show.
class ColorModel {
 public:
  static constexpr int kBins = 4096;
  static int BinOf(int red, int green, int blue) {
    return (red >> 4) << 8 | (green >> 4) << 4 | blue >> 4;
  }
  static int BinOf(const std::uint8_t* pixel, const Channels& c) {
    return BinOf(pixel[c.red], pixel[c.green], pixel[c.blue]);
  }

  ColorModel();

  /// Back to the prior.
  void Reset();
  /// Starts from a whole kRgb, kBgr or kGray picture, which stands for the surroundings: what a
  /// room is full of tells little of a head, be it as red as skin.
  void StartFrom(const ImageView& image);

  /// New observations: counts a bin, by class.
  struct Counts {
    std::array<std::array<float, kBins>, kNumColorClasses> bins{};
    std::array<float, kNumColorClasses> total{};
    void Add(ColorClass color, int bin, float weight = 1) {
      bins[color][static_cast<std::size_t>(bin)] += weight;
      total[color] += weight;
    }
    void Clear() {
      for (auto& counts : bins) counts.fill(0);
      total.fill(0);
    }
  };
  /// Mixes @p counts in, the first ones more than the later; classes with few counts are left
  /// alone.
  void Learn(Counts* counts);

  const std::vector<PackedScores>& table() const { return table_; }

 private:
  void Start();
  void MakeTable();

  std::array<std::vector<float>, kNumColorClasses> shares_;  // each sums to about 1
  std::array<std::vector<float>, 2> prior_;                  // of skin and hair
  std::vector<PackedScores> table_;
  int times_learned_{0};
};

}  // namespace visavis
