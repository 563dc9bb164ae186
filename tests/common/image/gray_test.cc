#include "common/image/gray.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace visavis {
namespace {

TEST(GrayTest, IsTheBrightnessOfEachPixelWhateverTheStride) {
  constexpr int kWidth = 5, kHeight = 3, kStride = 3 * kWidth + 7;
  std::vector<std::uint8_t> rgb(std::size_t{kStride} * kHeight);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(37 * i % 251);
  const ImageView picture{rgb.data(), kWidth, kHeight, kStride, rgb.size(), PixelFormat::kRgb};
  std::vector<std::uint8_t> pixels;
  const ImageView gray = ToGray(picture, &pixels);
  ASSERT_EQ(gray.format, PixelFormat::kGray);
  EXPECT_EQ(gray.stride, kWidth);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t* p = picture.row(y) + std::ptrdiff_t{3} * x;
      EXPECT_NEAR(gray.row(y)[x], 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2], 0.6);
    }
  }
}

TEST(GrayTest, OnlyRgbIsTaken) {
  std::vector<std::uint8_t> bytes(12), pixels;
  const ImageView bgr{bytes.data(), 2, 2, 6, bytes.size(), PixelFormat::kBgr};
  EXPECT_THROW(ToGray(bgr, &pixels), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
