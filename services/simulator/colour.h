#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace visavis {

/// A colour as designers write it: sRGB, each in [0, 1].
using Srgb = Eigen::Vector3d;

/// sRGB transfer function of one channel, both ways; linear light in [0, 1].
inline double LinearFromSrgb(double s) {
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}
inline double SrgbFromLinear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

inline Srgb MixColour(const Srgb& a, const Srgb& b, double t) { return a + (b - a) * t; }

/// The camera's response: linear radiance, 1 = white, to 8-bit sRGB with a shoulder that keeps
/// highlights from clipping hard (values up to 0.8 are plain sRGB), and its inverse.
class ResponseCurve {
 public:
  ResponseCurve();

  std::uint8_t Encode(float radiance) const {
    const float index = radiance * kSteps + 0.5f;
    return encode_[static_cast<std::size_t>(std::min(std::max(index, 0.0f), kMax * kSteps))];
  }
  float Decode(std::uint8_t value) const { return decode_[value]; }

 private:
  static constexpr float kSteps = 4096, kMax = 2.5f;
  std::array<std::uint8_t, static_cast<std::size_t>(kSteps* kMax) + 2> encode_;
  std::array<float, 256> decode_;
};

}  // namespace visavis
