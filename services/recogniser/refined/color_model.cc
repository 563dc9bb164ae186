#include "services/recogniser/refined/color_model.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr float kUniform = 1.0f / ColorModel::kBins;
constexpr float kFloor = 0.05f * kUniform;  ///< no colour is impossible
constexpr float kLeastRate = 0.06f;         ///< of new observations against the old
/// Of the prior for good: what was seen of a head from one side is not all of its colours.
constexpr float kPriorShare = 0.1f;
constexpr float kEnough = 20;  ///< counts that a class learns from

/// Each bin shares with its neighbours along the three axes.
void Blur(float* bins, float centre) {
  std::array<float, ColorModel::kBins> old;
  const float side = 0.5f * (1 - centre);
  for (const int step : {1, 16, 256}) {
    std::copy(bins, bins + ColorModel::kBins, old.begin());
    for (int i = 0; i < ColorModel::kBins; ++i) {
      const int level = i / step % 16;
      const auto at = static_cast<std::size_t>(i), s = static_cast<std::size_t>(step);
      const float below = level > 0 ? old[at - s] : old[at];
      const float above = level < 15 ? old[at + s] : old[at];
      bins[i] = centre * old[at] + side * (below + above);
    }
  }
}

void Normalise(std::vector<float>* bins) {
  float sum = 0;
  for (const float b : *bins) sum += b;
  for (float& b : *bins) b /= sum;
}

/// Skin of any tone under about white light: red leads, blue trails, from dark to pale.
float SkinPrior(float r, float g, float b) {
  const float rg = std::log(r / g), gb = std::log(g / b);
  // Bins are coarse: of dark colours the ratios are vague.
  const auto deviation = [](float level) { return std::hypot(0.17f, 7 / level); };
  const float x = (rg - 0.30f) / deviation(g), y = (gb - 0.22f) / deviation(b);
  const float value = std::max({r, g, b});
  return std::exp(-0.5f * (x * x + y * y)) * std::min(1.0f, value / 48);
}

/// Hair, or what covers it: anything, dark and dull colours before others.
float HairPrior(float r, float g, float b) {
  const float value = std::max({r, g, b}), saturation = 1 - std::min({r, g, b}) / value;
  return 0.15f + std::exp(-value / 50) + 0.3f * std::exp(-4 * saturation) * std::exp(-value / 150);
}

}  // namespace

ColorModel::ColorModel() : table_(kBins) {
  for (auto& shares : shares_) shares.resize(kBins);
  Reset();
}

void ColorModel::Reset() {
  std::fill(shares_[kSurroundings].begin(), shares_[kSurroundings].end(), 1.0f);
  Start();
}

void ColorModel::StartFrom(const ImageView& image) {
  std::vector<float>& bins = shares_[kSurroundings];
  std::fill(bins.begin(), bins.end(), 0.0f);
  const int red = image.format == PixelFormat::kBgr ? 2 : 0;
  for (int y = 0; y < image.height; y += 2) {
    const std::uint8_t* p = image.row(y);
    for (int x = 0; x < image.width; x += 2, p += 6) {
      bins[static_cast<std::size_t>(BinOf(p[red], p[1], p[2 - red]))] += 1;
    }
  }
  Blur(bins.data(), 0.6f);
  Start();
}

// The prior says how likely a colour is skin's or hair's; which of those colours there are at all
// the picture says.
void ColorModel::Start() {
  times_learned_ = 0;
  Normalise(&shares_[kSurroundings]);
  for (int i = 0; i < kBins; ++i) {
    const auto level = [&](int shift) { return static_cast<float>((i >> shift & 15) * 16 + 8); };
    const float r = level(8), g = level(4), b = level(0);
    const auto at = static_cast<std::size_t>(i);
    shares_[kSkinColor][at] = shares_[kSurroundings][at] * (SkinPrior(r, g, b) + 0.01f);
    shares_[kHairColor][at] = shares_[kSurroundings][at] * HairPrior(r, g, b);
  }
  Normalise(&shares_[kSkinColor]);
  Normalise(&shares_[kHairColor]);
  for (std::size_t c = 0; c < prior_.size(); ++c) prior_[c] = shares_[c];
  MakeTable();
}

void ColorModel::Learn(Counts* counts) {
  const float rate = std::max(kLeastRate, 1 / static_cast<float>(times_learned_ + 2));
  ++times_learned_;
  for (std::size_t c = 0; c < kNumColorClasses; ++c) {
    if (counts->total[c] < kEnough) continue;
    Blur(counts->bins[c].data(), 0.7f);
    const float scale = 1 / counts->total[c];
    for (std::size_t i = 0; i < kBins; ++i) {
      float& share = shares_[c][i];
      share += rate * (scale * counts->bins[c][i] - share);
    }
  }
  MakeTable();
}

void ColorModel::MakeTable() {
  const auto byte = [](float ratio) {
    const float score = kScorePerNat * std::log(ratio);
    return static_cast<std::uint32_t>(
        std::lround(std::clamp(score + static_cast<float>(kScoreZero), 1.0f, 255.0f)));
  };
  for (std::size_t i = 0; i < kBins; ++i) {
    const auto mixed = [&](ColorClass c) {
      return (1 - kPriorShare) * shares_[c][i] + kPriorShare * prior_[c][i] + kFloor;
    };
    const float skin = mixed(kSkinColor), hair = mixed(kHairColor);
    const float around = 1 / (shares_[kSurroundings][i] + kFloor);
    table_[i] = byte(hair * around) | byte(skin * around) << 8 |
                byte(0.5f * (hair + skin) * around) << 16 | 0xff000000u;
  }
}

}  // namespace visavis
