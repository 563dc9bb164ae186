#include "common/image/image_decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "common/core/random.h"
#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Color = std::array<std::uint8_t, 3>;

constexpr int kWidth = 64, kHeight = 48;

// A picture with memory of its own.
struct Picture {
  std::vector<std::uint8_t> bytes;
  ImageView view;
};

// Soft slopes, which JPEG keeps well; each channel another one.
Picture Slopes(PixelFormat format, int stride = 0) {
  const int channels = BytesPerPixel(format);
  if (stride == 0) stride = kWidth * channels;
  Picture picture{std::vector<std::uint8_t>(static_cast<std::size_t>(stride) * kHeight, 0xEE), {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const int values[3] = {3 * x + 20, 4 * y + 10, 200 - x - y};
      for (int c = 0; c < channels; ++c) {
        const int value = values[format == PixelFormat::kBgr ? 2 - c : c];
        picture.bytes[static_cast<std::size_t>(y * stride + x * channels + c)] =
            static_cast<std::uint8_t>(value);
      }
    }
  }
  picture.view = {picture.bytes.data(), kWidth, kHeight, stride, picture.bytes.size(), format};
  return picture;
}

// A one-coloured scene through a Bayer filter whose 2x2 cell reads @p letters row by row.
Picture Mosaic(PixelFormat format, const std::string& letters, const Color& rgb) {
  Picture picture{std::vector<std::uint8_t>(kWidth * kHeight), {}};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const char letter = letters[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
      const std::size_t channel = letter == 'R' ? 0 : letter == 'G' ? 1 : 2;
      picture.bytes[static_cast<std::size_t>(y * kWidth + x)] = rgb[channel];
    }
  }
  picture.view = {picture.bytes.data(), kWidth, kHeight, kWidth, picture.bytes.size(), format};
  return picture;
}

int LargestDifference(const ImageView& a, const ImageView& b) {
  const int bytes = a.width * BytesPerPixel(a.format);
  int largest = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int i = 0; i < bytes; ++i)
      largest = std::max(largest, std::abs(a.row(y)[i] - b.row(y)[i]));
  }
  return largest;
}

TEST(ImageTest, EveryFormatHasItsNameAndSize) {
  const std::vector<std::pair<std::string, int>> expected{
      {"gray", 1},       {"rgb", 3},        {"bgr", 3},        {"bayer_bggr", 1},
      {"bayer_gbrg", 1}, {"bayer_grbg", 1}, {"bayer_rggb", 1}, {"jpeg", 0}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const auto format = static_cast<PixelFormat>(i);
    EXPECT_EQ(PixelFormatName(format), expected[i].first);
    EXPECT_EQ(BytesPerPixel(format), expected[i].second);
  }
}

TEST(ImageDecoderTest, RawPicturesComeBackAsTheyAreWithoutACopy) {
  ImageDecoder decoder;
  for (const auto format : {PixelFormat::kGray, PixelFormat::kRgb, PixelFormat::kBgr}) {
    const Picture picture = Slopes(format, 200);
    const ImageView decoded = decoder.Decode(picture.view);
    EXPECT_EQ(decoded.data, picture.bytes.data());
    EXPECT_EQ(decoded.stride, 200);
    EXPECT_EQ(decoded.format, format);
  }
}

TEST(ImageDecoderTest, EveryBayerPatternGivesTheColourThatWentIn) {
  const std::vector<std::pair<PixelFormat, std::string>> patterns{
      {PixelFormat::kBayerBggr, "BGGR"},
      {PixelFormat::kBayerGbrg, "GBRG"},
      {PixelFormat::kBayerGrbg, "GRBG"},
      {PixelFormat::kBayerRggb, "RGGB"}};
  const Color orange{230, 120, 15};
  ImageDecoder decoder;
  for (const auto& [format, letters] : patterns) {
    const Picture mosaic = Mosaic(format, letters, orange);
    const ImageView rgb = decoder.Decode(mosaic.view);
    ASSERT_EQ(rgb.format, PixelFormat::kRgb) << letters;
    EXPECT_EQ(rgb.width, kWidth);
    EXPECT_EQ(rgb.height, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const std::uint8_t* pixel = rgb.row(y) + 3 * x;
        ASSERT_EQ((Color{pixel[0], pixel[1], pixel[2]}), orange) << letters << x << "," << y;
      }
    }
  }
}

TEST(ImageDecoderTest, ABayerPictureWithPaddedRowsIsReadRowByRow) {
  const Picture packed = Mosaic(PixelFormat::kBayerRggb, "RGGB", {10, 200, 90});
  Picture padded{std::vector<std::uint8_t>((kWidth + 7) * kHeight, 255), packed.view};
  for (int y = 0; y < kHeight; ++y) {
    std::copy_n(packed.view.row(y), kWidth, padded.bytes.begin() + y * (kWidth + 7));
  }
  padded.view.data = padded.bytes.data();
  padded.view.stride = kWidth + 7;
  ImageDecoder one, other;
  EXPECT_EQ(LargestDifference(one.Decode(packed.view), other.Decode(padded.view)), 0);
}

TEST(ImageDecoderTest, JpegRoundTripKeepsColoursInTheirPlaces) {
  JpegEncoder encoder;
  ImageDecoder decoder;
  const Picture rgb = Slopes(PixelFormat::kRgb);
  for (const auto format : {PixelFormat::kRgb, PixelFormat::kBgr}) {
    const ImageView jpeg = encoder.Encode(Slopes(format, 250).view, 95);
    EXPECT_EQ(jpeg.format, PixelFormat::kJpeg);
    EXPECT_LT(jpeg.size, rgb.bytes.size() / 3);
    const ImageView decoded = decoder.Decode(jpeg);
    ASSERT_EQ(decoded.format, PixelFormat::kRgb);
    EXPECT_LE(LargestDifference(decoded, rgb.view), 8);  // swapped channels differ by more than 100
  }
}

TEST(ImageDecoderTest, AGreyJpegDecodesToGrey) {
  JpegEncoder encoder;
  ImageDecoder decoder;
  const Picture gray = Slopes(PixelFormat::kGray);
  const ImageView decoded = decoder.Decode(encoder.Encode(gray.view, 95));
  ASSERT_EQ(decoded.format, PixelFormat::kGray);
  EXPECT_EQ(decoded.stride, kWidth);
  EXPECT_LE(LargestDifference(decoded, gray.view), 4);
}

TEST(ImageDecoderTest, LowerQualityTakesFewerBytes) {
  JpegEncoder encoder;
  Random random(1);
  Picture noise = Slopes(PixelFormat::kRgb);
  for (auto& byte : noise.bytes) byte = static_cast<std::uint8_t>(random.Index(256));
  const std::size_t fine = encoder.Encode(noise.view, 100).size;
  EXPECT_LT(encoder.Encode(noise.view, 30).size, fine / 2);
}

TEST(ImageDecoderTest, RefusesAJpegOfAnotherSizeThanItsMessageSays) {
  JpegEncoder encoder;
  ImageDecoder decoder;
  ImageView jpeg = encoder.Encode(Slopes(PixelFormat::kRgb).view, 90);
  jpeg.width = 640;
  EXPECT_THAT([&] { decoder.Decode(jpeg); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("JPEG of 64x48"), HasSubstr("must be 640x48"))));
}

TEST(ImageDecoderTest, RefusesWhatIsNoJpeg) {
  ImageDecoder decoder;
  const std::vector<std::uint8_t> text(100, 'x');
  EXPECT_THAT(
      [&] {
        decoder.Decode({text.data(), kWidth, kHeight, 0, text.size(), PixelFormat::kJpeg});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("image: is no JPEG")));
}

TEST(ImageDecoderTest, RefusesACutJpegAndDecodesTheNext) {
  JpegEncoder encoder;
  ImageDecoder decoder;
  const ImageView whole = encoder.Encode(Slopes(PixelFormat::kRgb).view, 90);
  ImageView cut = whole;
  cut.size = whole.size - 20;
  EXPECT_THAT([&] { decoder.Decode(cut); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("image: damaged JPEG")));
  EXPECT_NO_THROW(decoder.Decode(whole));
}

TEST(ImageDecoderTest, SurvivesAnyDamageToAJpeg) {
  JpegEncoder encoder;
  ImageDecoder decoder;
  const ImageView whole = encoder.Encode(Slopes(PixelFormat::kRgb).view, 90);
  const std::vector<std::uint8_t> good(whole.data, whole.data + whole.size);
  Random random(7);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    auto bytes = good;
    for (int k = random.Index(8); k >= 0; --k) {
      bytes[static_cast<std::size_t>(random.Index(static_cast<int>(bytes.size())))] =
          static_cast<std::uint8_t>(random.Index(256));
    }
    bytes.resize(static_cast<std::size_t>(1 + random.Index(static_cast<int>(bytes.size()))));
    try {
      const ImageView view{bytes.data(), kWidth, kHeight, 0, bytes.size(), PixelFormat::kJpeg};
      EXPECT_EQ(decoder.Decode(view).width, kWidth);
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST(ImageDecoderTest, NothingIsAllocatedOnceAPictureHasBeenDecoded) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  ImageDecoder decoder;
  const Picture raw = Slopes(PixelFormat::kRgb);
  const Picture bayer = Mosaic(PixelFormat::kBayerGrbg, "GRBG", {1, 2, 3});
  decoder.Decode(raw.view);
  decoder.Decode(bayer.view);
  const std::int64_t before = NumMallocs();
  for (int i = 0; i < 10; ++i) decoder.Decode(raw.view);
  EXPECT_EQ(NumMallocs() - before, 0);
  const std::int64_t bytes_before = NumMallocBytes();
  for (int i = 0; i < 10; ++i) decoder.Decode(bayer.view);
  EXPECT_LT(NumMallocBytes() - bytes_before, 10 * kWidth * kHeight);  // OpenCV's own bookkeeping
}

TEST(JpegEncoderTest, RefusesQualityAndFormatByName) {
  JpegEncoder encoder;
  const Picture rgb = Slopes(PixelFormat::kRgb);
  EXPECT_THAT([&] { encoder.Encode(rgb.view, 0); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("quality = 0")));
  const Picture bayer = Mosaic(PixelFormat::kBayerRggb, "RGGB", {1, 2, 3});
  EXPECT_THAT([&] { encoder.Encode(bayer.view, 90); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("bayer_rggb")));
}

}  // namespace
}  // namespace visavis
