#include "services/simulator/sensor.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"
#include "common/core/random.h"

namespace visavis {
namespace {

constexpr std::size_t kTableSize = std::size_t{1} << 20;

/// Scrambles a counter into independent bits (SplitMix64).
std::uint64_t Scramble(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

}  // namespace

double SensorConfig::Gain(int camera, double t_s) const {
  return gain * (camera == 1 ? left_gain : 1) *
         (1 + drift * std::sin(2 * M_PI * t_s / drift_period_s));
}

Sensor::Sensor(const SensorConfig& config, std::uint64_t seed) : config_(config), seed_(seed) {
  if (config.noise_sigma <= 0) return;
  Random random(Scramble(seed));
  noise_.reserve(kTableSize);
  for (std::size_t i = 0; i < kTableSize; ++i) {
    noise_.push_back(static_cast<std::int8_t>(
        std::clamp<long>(std::lround(config.noise_sigma * random.Normal()), -127, 127)));
  }
}

void Sensor::Expose(std::int64_t picture_number, int camera, double t_s,
                    const RgbView& picture) const {
  const auto gain = static_cast<int>(std::lround(256 * config_.Gain(camera, t_s)));
  if (gain == 256 && noise_.empty()) return;
  const auto bytes = static_cast<std::size_t>(3 * picture.width);
  VISAVIS_THROW_UNLESS(bytes < kTableSize, picture.width);
  const std::uint64_t key =
      Scramble(seed_ ^ Scramble(2 * static_cast<std::uint64_t>(picture_number) +
                                static_cast<std::uint64_t>(camera)));
  for (int y = 0; y < picture.height; ++y) {
    std::uint8_t* row = picture.row(y);
    // Each row is a piece of one long table of noise, from a place of its own.
    const std::uint64_t at = Scramble(key + static_cast<std::uint64_t>(y)) % (kTableSize - bytes);
    const std::int8_t* noise = noise_.empty() ? nullptr : noise_.data() + at;
    if (gain != 256) {
      for (std::size_t i = 0; i < bytes; ++i) {
        row[i] = static_cast<std::uint8_t>(std::min((row[i] * gain + 128) >> 8, 255));
      }
    }
    if (noise == nullptr) continue;
    for (std::size_t i = 0; i < bytes; ++i) {
      row[i] = static_cast<std::uint8_t>(std::clamp(row[i] + noise[i], 0, 255));
    }
  }
}

void ExposureSum::Clear(int width, int height) {
  sum_.assign(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0f);
  count_ = 0;
}

void ExposureSum::Add(const RgbView& picture) {
  const auto bytes = static_cast<std::size_t>(3 * picture.width);
  for (int y = 0; y < picture.height; ++y) {
    float* to = sum_.data() + static_cast<std::size_t>(y) * bytes;
    for (std::size_t i = 0; i < bytes; ++i) to[i] += response_.Decode(picture.row(y)[i]);
  }
  ++count_;
}

void ExposureSum::Write(const RgbView& picture) const {
  const auto bytes = static_cast<std::size_t>(3 * picture.width);
  const float scale = 1 / static_cast<float>(std::max(count_, 1));
  for (int y = 0; y < picture.height; ++y) {
    const float* from = sum_.data() + static_cast<std::size_t>(y) * bytes;
    for (std::size_t i = 0; i < bytes; ++i) {
      picture.row(y)[i] = response_.Encode(scale * from[i]);
    }
  }
}

}  // namespace visavis
