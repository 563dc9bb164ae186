#include "services/simulator/sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace visavis {
namespace {

constexpr int kWidth = 320, kHeight = 240;

struct Grey {
  explicit Grey(std::uint8_t level) : rgb(3 * kWidth * kHeight, level) {}
  RgbView view() { return {rgb.data(), kWidth, kHeight, 3 * kWidth}; }
  double Mean() const {
    double sum = 0;
    for (const int value : rgb) sum += value;
    return sum / static_cast<double>(rgb.size());
  }
  double Sigma() const {
    const double mean = Mean();
    double sum = 0;
    for (const int value : rgb) sum += (value - mean) * (value - mean);
    return std::sqrt(sum / static_cast<double>(rgb.size()));
  }
  std::vector<std::uint8_t> rgb;
};

SensorConfig WithNoise(double sigma) {
  SensorConfig config;
  config.noise_sigma = sigma;
  return config;
}

TEST(SensorTest, NoiseHasMeanZeroAndTheSigmaAskedFor) {
  for (const double sigma : {2.0, 4.0, 10.0}) {
    Grey grey(128);
    Sensor(WithNoise(sigma), 1).Expose(0, 0, 0, grey.view());
    EXPECT_NEAR(grey.Mean(), 128, 0.1) << sigma;
    EXPECT_NEAR(grey.Sigma(), std::sqrt(sigma * sigma + 1.0 / 12), 0.02 * sigma) << sigma;
  }
}

TEST(SensorTest, NeighboursRowsAndChannelsAreUncorrelated) {
  Grey grey(128);
  Sensor(WithNoise(4), 1).Expose(0, 0, 0, grey.view());
  const auto correlation = [&grey](std::size_t lag) {
    double sum = 0;
    std::size_t n = 0;
    for (std::size_t i = 0; i + lag < grey.rgb.size(); ++i, ++n) {
      sum += (grey.rgb[i] - 128.0) * (grey.rgb[i + lag] - 128.0);
    }
    return sum / static_cast<double>(n) / 16;
  };
  for (const std::size_t lag : {1, 3, 3 * kWidth}) EXPECT_NEAR(correlation(lag), 0, 0.015) << lag;
}

TEST(SensorTest, SamePictureNumberSameNoiseAndOnlyThen) {
  const Sensor sensor(WithNoise(4), 7);
  const auto expose = [](const Sensor& s, std::int64_t number, int camera) {
    Grey grey(100);
    s.Expose(number, camera, 0.5, grey.view());
    return grey.rgb;
  };
  const auto first = expose(sensor, 3, 0);
  EXPECT_EQ(first, expose(sensor, 3, 0));
  EXPECT_NE(first, expose(sensor, 4, 0));
  EXPECT_NE(first, expose(sensor, 3, 1));
  EXPECT_NE(first, expose(Sensor(WithNoise(4), 8), 3, 0));
}

TEST(SensorTest, GainMultipliesAndClips) {
  SensorConfig config = WithNoise(0);
  config.gain = 1.5;
  config.left_gain = 2;
  Grey right(100), left(100);
  const Sensor sensor(config, 1);
  sensor.Expose(0, 0, 0, right.view());
  sensor.Expose(0, 1, 0, left.view());
  EXPECT_EQ(right.rgb[5], 150);
  EXPECT_EQ(left.rgb[5], 255);
}

TEST(SensorTest, BrightnessDriftsWithItsPeriod) {
  SensorConfig config = WithNoise(0);
  config.drift = 0.3;
  config.drift_period_s = 8;
  EXPECT_NEAR(config.Gain(0, 0), 1, 1e-12);
  EXPECT_NEAR(config.Gain(0, 2), 1.3, 1e-12);
  EXPECT_NEAR(config.Gain(0, 6), 0.7, 1e-12);
  Grey grey(100);
  Sensor(config, 1).Expose(0, 0, 2, grey.view());
  EXPECT_EQ(grey.rgb[0], 130);
}

TEST(SensorTest, WithoutNoiseAndGainNothingChanges) {
  Grey grey(77);
  Sensor(WithNoise(0), 1).Expose(0, 0, 0, grey.view());
  EXPECT_EQ(grey.rgb, Grey(77).rgb);
}

TEST(ExposureSumTest, AveragesLightNotValues) {
  Grey black(0), white(255), out(0);
  ExposureSum sum;
  sum.Clear(kWidth, kHeight);
  sum.Add(black.view());
  sum.Add(white.view());
  sum.Write(out.view());
  EXPECT_GT(out.rgb[0], 170);  // half the light is far above the middle value
  sum.Clear(kWidth, kHeight);
  Grey grey(90);
  sum.Add(grey.view());
  sum.Write(out.view());
  EXPECT_EQ(out.rgb[0], 90);
}

}  // namespace
}  // namespace visavis
