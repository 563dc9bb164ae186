#include "services/recogniser/refined/band_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/malloc_counter.h"
#include "tests/support/naive_bands.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr int kWidth = 160, kHeight = 128;
constexpr PixelBox kWhole{0, 0, kWidth, kHeight};
constexpr std::array<Band, kNumBands> kBands = {kFineBand, kCoarseBand};

/// A grey picture whose brightness at (x, y) is @p value.
OwnedImage Picture(const std::function<double(double x, double y)>& value) {
  OwnedImage image;
  image.bytes.resize(static_cast<std::size_t>(kWidth * kHeight));
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      image.bytes[static_cast<std::size_t>(y * kWidth + x)] =
          static_cast<std::uint8_t>(std::lround(std::clamp(value(x, y), 0.0, 255.0)));
    }
  }
  image.view = {image.bytes.data(), kWidth, kHeight, kWidth, image.bytes.size(),
                PixelFormat::kGray};
  return image;
}

BandImages BandsOf(const ImageView& view, const PixelBox& box = kWhole) {
  BandImages bands(view.width, view.height);
  bands.Build(view, box);
  return bands;
}

float ValueAt(const BandImages& bands, Band band, float u, float v) {
  BandSample sample{};
  EXPECT_TRUE(SampleBand(bands.view(band), u, v, &sample)) << u << " " << v;
  return sample.value;
}

/// Largest value of @p band, well away from the border.
float Largest(const BandImages& bands, Band band) {
  float largest = 0;
  for (float v = 48; v < kHeight - 48; v += 1) {
    for (float u = 48; u < kWidth - 48; u += 1)
      largest = std::max(largest, std::abs(ValueAt(bands, band, u, v)));
  }
  return largest;
}

/// How much of a wave of @p length_px along x is left.
double Gain(Band band, double length_px) {
  const double amplitude = 100;
  const OwnedImage wave = Picture(
      [&](double x, double /*y*/) { return 128 + amplitude * std::sin(2 * M_PI * x / length_px); });
  return static_cast<double>(Largest(BandsOf(wave.view), band)) / amplitude;
}

TEST(BandImagesTest, AConstantPictureIsZero) {
  for (const double level : {0.0, 77.0, 255.0}) {
    const BandImages bands = BandsOf(Picture([&](double, double) { return level; }).view);
    for (const Band band : kBands) EXPECT_LT(Largest(bands, band), 1e-4f);
  }
}

TEST(BandImagesTest, ALinearRampIsAboutZero) {
  const BandImages bands =
      BandsOf(Picture([](double x, double y) { return 20 + 0.75 * x + 0.5 * y; }).view);
  // Bytes round: +-0.5 of noise before smoothing.
  for (const Band band : kBands) EXPECT_LT(Largest(bands, band), 0.3f);
}

TEST(BandImagesTest, EachBandPassesItsOwnWavesAndDampsTheOthers) {
  // At 0.8 px a mm: 2 to 7 mm are blobs of 2 to 6 px, waves about four times as long.
  EXPECT_GT(Gain(kFineBand, 16), 0.4);
  EXPECT_GT(Gain(kCoarseBand, 32), 0.4);
  for (const double far : {3.0, 160.0}) EXPECT_LT(Gain(kFineBand, far), 0.15) << far;
  for (const double far : {6.0, 320.0}) EXPECT_LT(Gain(kCoarseBand, far), 0.15) << far;
}

TEST(BandImagesTest, BandsAreLinearInThePicture) {
  const auto a = [](double x, double y) { return 30 * std::sin(0.3 * x) * std::cos(0.2 * y); };
  const auto b = [](double x, double y) { return 30 * std::sin(0.15 * x + 0.25 * y); };
  const BandImages of_a = BandsOf(Picture([&](double x, double y) { return 90 + a(x, y); }).view);
  const BandImages of_b = BandsOf(Picture([&](double x, double y) { return 90 + b(x, y); }).view);
  const BandImages of_both =
      BandsOf(Picture([&](double x, double y) { return 120 + 2 * a(x, y) + b(x, y); }).view);
  for (const Band band : kBands) {
    for (float u = 40; u < 120; u += 7.3f) {
      EXPECT_NEAR(ValueAt(of_both, band, u, 61),
                  2 * ValueAt(of_a, band, u, 61) + ValueAt(of_b, band, u, 61), 0.6f);
    }
  }
}

TEST(BandImagesTest, TheGradientEqualsFiniteDifferences) {
  const BandImages bands =
      BandsOf(Picture([](double x, double y) {
                return 128 + 50 * std::sin(0.21 * x + 0.1 * y) + 50 * std::cos(0.17 * y - 0.08 * x);
              }).view);
  for (const Band band : kBands) {
    const float h = band == kFineBand ? 2 : 4;  // one sample
    double error = 0, size = 0;
    for (float v = 45; v < 80; v += 1.7f) {
      for (float u = 45; u < 110; u += 1.3f) {
        BandSample s{};
        ASSERT_TRUE(SampleBand(bands.view(band), u, v, &s));
        const auto du = static_cast<double>(
            (ValueAt(bands, band, u + h, v) - ValueAt(bands, band, u - h, v)) / (2 * h));
        const auto dv = static_cast<double>(
            (ValueAt(bands, band, u, v + h) - ValueAt(bands, band, u, v - h)) / (2 * h));
        EXPECT_NEAR(s.du, du, 1e-3);
        EXPECT_NEAR(s.dv, dv, 1e-3);
        // And the slope of the smooth picture beneath, to what interpolation loses.
        const float e = 0.5f;
        error += std::abs(
            static_cast<double>(s.du) -
            static_cast<double>(ValueAt(bands, band, u + e, v) - ValueAt(bands, band, u - e, v)));
        size += std::abs(du);
      }
    }
    EXPECT_LT(error, 0.25 * size);
  }
}

TEST(BandImagesTest, ASymmetricBlobPeaksAtItsOwnCentre) {
  // Pixel (x, y) is the centre of a pixel: the bands' samples lie between them.
  for (const double centre : {80.0, 80.5, 81.7}) {
    const BandImages bands = BandsOf(Picture([&](double x, double y) {
                                       const double r2 =
                                           std::pow(x - centre, 2) + std::pow(y - centre + 20, 2);
                                       return 60 + 150 * std::exp(-r2 / (2 * 4.0 * 4.0));
                                     }).view);
    for (const Band band : kBands) {
      double sum = 0, weighted = 0;
      for (float u = 60; u < 102; u += 0.25f) {
        const auto value = static_cast<double>(
            std::max(0.0f, ValueAt(bands, band, u, static_cast<float>(centre - 20))));
        sum += value;
        weighted += value * static_cast<double>(u);
      }
      EXPECT_NEAR(weighted / sum, centre, 0.06) << band;
    }
  }
}

TEST(BandImagesTest, BrightnessIsThatOfRedButForItsFinestDetails) {
  // What changes along x in red alone.
  const auto level = [](double x) { return 120 + 60 * std::sin(2 * M_PI * x / 40); };
  OwnedImage rgb = FlatImage(kWidth, kHeight, 0, 77, 200);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      rgb.bytes[static_cast<std::size_t>(3 * (y * kWidth + x))] =
          static_cast<std::uint8_t>(std::lround(level(x)));
  }
  const OwnedImage gray = Picture([&](double x, double /*y*/) { return level(x); });
  for (const OwnedImage* image : std::array<const OwnedImage*, 2>{&rgb, &gray}) {
    const BandImages bands = BandsOf(image->view);
    for (float u = 40; u < 120; u += 3.7f) {
      const float value = ValueAt(bands, kBrightness, u, 60);
      EXPECT_NEAR(static_cast<double>(value), level(static_cast<double>(u)), 6) << u;
    }
  }
  const OwnedImage fine = Picture([](double x, double y) {
    return static_cast<int>(x / 2 + std::floor(y / 2)) % 2 == 0 ? 40 : 200;
  });
  EXPECT_NEAR(ValueAt(BandsOf(fine.view), kBrightness, 80, 60), 120, 5);
}

TEST(BandImagesTest, ABoxGivesWhatTheWholePictureGivesAwayFromItsBorder) {
  Random random(1);
  const OwnedImage noise = NoiseImage(kWidth, kHeight, &random);
  const BandImages whole = BandsOf(noise.view), part = BandsOf(noise.view, {24, 16, 152, 120});
  for (const Band band : kBands) {
    const float margin = band == kFineBand ? 32 : 56;
    for (float v = 16 + margin; v < 120 - margin; v += 1.5f) {
      for (float u = 24 + margin; u < 152 - margin; u += 1.5f) {
        EXPECT_NEAR(ValueAt(part, band, u, v), ValueAt(whole, band, u, v), 1e-3f);
      }
    }
  }
}

TEST(BandImagesTest, OutsideOfTheBoxAndNearItsBorderThereIsNothing) {
  Random random(2);
  const BandImages bands = BandsOf(NoiseImage(kWidth, kHeight, &random).view, {32, 24, 128, 104});
  BandSample sample{};
  float value;
  for (const Band band : kBands) {
    for (const auto& [u, v] : {std::pair(10.f, 60.f),
                               {150.f, 60.f},
                               {80.f, 5.f},
                               {80.f, 120.f},
                               {34.f, 60.f},
                               {126.f, 60.f},
                               {80.f, 26.f},
                               {80.f, 102.f}}) {
      EXPECT_FALSE(SampleBand(bands.view(band), u, v, &sample)) << u << " " << v;
    }
    EXPECT_FALSE(SampleBand(bands.view(band), NAN, 60, &sample));
    EXPECT_FALSE(NearestSample(bands.view(band), 31, 60, &value));
    EXPECT_FALSE(NearestSample(bands.view(band), 128, 60, &value));
    EXPECT_FALSE(NearestSample(bands.view(band), 60, NAN, &value));
    EXPECT_TRUE(NearestSample(bands.view(band), 32, 24, &value));
    EXPECT_TRUE(NearestSample(bands.view(band), 127, 103, &value));
    EXPECT_TRUE(SampleBand(bands.view(band), 80, 60, &sample));
  }
}

TEST(BandImagesTest, BeforeAnyPictureThereIsNothing) {
  const BandImages bands(kWidth, kHeight);
  BandSample sample{};
  float value;
  EXPECT_FALSE(SampleBand(bands.view(kFineBand), 80, 60, &sample));
  EXPECT_FALSE(NearestSample(bands.view(kCoarseBand), 80, 60, &value));
}

TEST(BandImagesTest, NearestIsTheValueAtASample) {
  Random random(3);
  const BandImages bands = BandsOf(NoiseImage(kWidth, kHeight, &random).view);
  for (const Band band : kBands) {
    const float size = band == kFineBand ? 2 : 4;
    for (float k = 12; k < 20; k += 1) {
      const float centre = (k + 0.5f) * size - 0.5f;  // of sample k, in pixels
      const float expected = ValueAt(bands, band, centre, centre);
      for (const float aside : {-0.45f, 0.0f, 0.45f}) {
        float value;
        ASSERT_TRUE(
            NearestSample(bands.view(band), centre + aside * size, centre - aside * size, &value));
        EXPECT_NEAR(value, expected, 1e-4f);
      }
    }
  }
}

TEST(BandImagesTest, RgbBgrAndGrayOfTheSamePictureAgree) {
  Random random(4);
  const OwnedImage rgb = NoiseImage(kWidth, kHeight, &random);
  const OwnedImage bgr = BgrImage(rgb.view), gray = GrayImage(rgb.view);
  const BandImages of_rgb = BandsOf(rgb.view), of_bgr = BandsOf(bgr.view),
                   of_gray = BandsOf(gray.view);
  for (const Band band : kBands) {
    for (float v = 40; v < 90; v += 3.3f) {
      for (float u = 40; u < 120; u += 3.1f) {
        const float value = ValueAt(of_rgb, band, u, v);
        EXPECT_EQ(value, ValueAt(of_bgr, band, u, v));
        EXPECT_NEAR(value, ValueAt(of_gray, band, u, v), 0.5f);
      }
    }
  }
}

TEST(BandImagesTest, BuildingAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  Random random(5);
  const OwnedImage rgb = NoiseImage(kWidth, kHeight, &random), gray = GrayImage(rgb.view);
  BandImages bands(kWidth, kHeight);
  const std::int64_t before = NumMallocs();
  bands.Build(rgb.view, kWhole);
  bands.Build(gray.view, {8, 8, 104, 96});
  EXPECT_EQ(NumMallocs(), before);
}

TEST(BandImagesTest, ABoxOffTheGridOrAPictureTooSmallIsRefused) {
  const OwnedImage image = FlatImage(kWidth, kHeight, 1, 2, 3);
  BandImages bands(kWidth, kHeight);
  using ::testing::Throws;
  for (const PixelBox& box : {PixelBox{4, 0, 64, 64}, PixelBox{0, 4, 64, 64},
                              PixelBox{0, 0, 60, 64}, PixelBox{0, 0, 64, 60}}) {
    EXPECT_THAT([&] { bands.Build(image.view, box); }, Throws<std::invalid_argument>());
  }
  EXPECT_THAT([] { BandImages bad(15, 64); }, Throws<std::invalid_argument>());
  EXPECT_THAT([] { BandImages bad(64, 15); }, Throws<std::invalid_argument>());
}

}  // namespace
}  // namespace visavis
