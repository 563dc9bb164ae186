#include "services/recogniser/refined/color_model.h"

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/picture_kernel.h"

namespace visavis {
namespace {

constexpr float kUniform = 1.0f / ColorModel::kBins;
constexpr float kFloor = 0.05f * kUniform;  ///< no colour is impossible
constexpr float kLeastRate = 0.06f;         ///< of new observations against the old
/// Of the prior for good: what was seen of a head from one side is not all of its colours.
constexpr float kPriorShare = 0.1f;
constexpr float kEnough = 20;  ///< counts that a class learns from

/// Each bin shares with its neighbours along the three axes; the borders repeat.
/// Of levels of grey most leaks aside, to colours that grey pixels never have: so they stay vague,
/// which serves better than blurring along the levels alone.
void Blur(float* bins, float centre) {
  std::array<float, ColorModel::kBins> old;
  const float side = 0.5f * (1 - centre);
  for (const int step : {1, 16, 256}) {
    std::copy(bins, bins + ColorModel::kBins, old.begin());
    for (int block = 0; block < ColorModel::kBins; block += 16 * step) {
      for (int level = 0; level < 16; ++level) {
        const std::ptrdiff_t at = std::ptrdiff_t{level} * step + block;
        const float* here = old.data() + at;
        const float* below = level > 0 ? here - step : here;
        const float* above = level < 15 ? here + step : here;
        float* out = bins + at;
        for (int i = 0; i < step; ++i) out[i] = centre * here[i] + side * (below[i] + above[i]);
      }
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
  const Channels channels(image.format);
  for (int y = 0; y < image.height; y += 2) {
    const std::uint8_t* p = image.row(y);
    for (int x = 0; x < image.width; x += 2, p += std::ptrdiff_t{2} * channels.step)
      bins[static_cast<std::size_t>(BinOf(p, channels))] += 1;
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
  std::array<float, kBins> skin, hair, surroundings;
  const auto mix = [&](ColorClass c, std::array<float, kBins>* mixed) {
    const float *share = shares_[c].data(), *prior = prior_[c].data();
    for (std::size_t i = 0; i < kBins; ++i)
      (*mixed)[i] = (1 - kPriorShare) * share[i] + kPriorShare * prior[i] + kFloor;
  };
  mix(kSkinColor, &skin);
  mix(kHairColor, &hair);
  for (std::size_t i = 0; i < kBins; ++i) surroundings[i] = shares_[kSurroundings][i] + kFloor;
  MakeScores({skin.data(), hair.data(), surroundings.data()}, kBins, table_.data());
}

}  // namespace visavis
