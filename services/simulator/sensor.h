#pragma once

#include <cstdint>
#include <vector>

#include "common/config/rule.h"
#include "services/simulator/colour.h"
#include "services/simulator/rgb_view.h"

namespace visavis {

/// What the cameras' electronics do to a picture.
struct SensorConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("noise_sigma", &noise_sigma, InRange(0.0, 40.0));
    a->Visit("gain", &gain, InRange(0.05, 10.0));
    a->Visit("left_gain", &left_gain, InRange(0.2, 5.0));
    a->Visit("drift", &drift, InRange(0.0, 0.9));
    a->Visit("drift_period_s", &drift_period_s, InRange(0.1, 1e6, "s"));
    a->Visit("exposure_ms", &exposure_ms, InRange(0.0, 1000.0, "ms"));
    a->Visit("blur_samples", &blur_samples, InRange(1, 64));
  }
  /// Factor on the 8-bit values of the right (0) or left (1) camera at @p t_s.
  double Gain(int camera, double t_s) const;

  double noise_sigma{4};      ///< standard deviation of the noise of each channel [levels of 255]
  double gain{1};             ///< factor on the 8-bit values
  double left_gain{1};        ///< further factor for the left camera
  double drift{0};            ///< the gain swings by this share, 0 to 0.9 ...
  double drift_period_s{10};  ///< ... with this period
  double exposure_ms{8};      ///< shutter time
  int blur_samples{1};        ///< pictures averaged over the shutter time; 1: no motion blur
};

/// Adds gain and noise to finished pictures. The noise depends on seed, picture number, camera and
/// place alone.
class Sensor {
 public:
  Sensor(const SensorConfig& config, std::uint64_t seed);

  /// @p picture_number: counts a camera's pictures; @p camera 0 right, 1 left.
  void Expose(std::int64_t picture_number, int camera, double t_s, const RgbView& picture) const;

 private:
  SensorConfig config_;
  std::uint64_t seed_;
  std::vector<std::int8_t> noise_;
};

/// Mean light of several pictures (motion blur). Buffers are allocated once.
class ExposureSum {
 public:
  void Clear(int width, int height);
  void Add(const RgbView& picture);
  /// Writes the mean of what was added.
  void Write(const RgbView& picture) const;

 private:
  ResponseCurve response_;
  std::vector<float> sum_;
  int count_{0};
};

}  // namespace visavis
