#include "services/stereo_capture/stereo_capture_messages.h"

#include <gtest/gtest.h>

#include <numeric>

#include "common/convert/image_message.h"

namespace visavis {
namespace {

StampedFrame Frame(Side side, PixelFormat format, int width, int height, std::size_t padding = 0) {
  StampedFrame stamped;
  CapturedFrame& frame = stamped.frame;
  frame.side = side;
  const int stride = width * BytesPerPixel(format);
  const auto size = static_cast<std::size_t>(stride) * height;
  frame.pixels = std::make_shared<std::vector<std::uint8_t>>(size + padding);
  std::iota(frame.pixels->begin(), frame.pixels->end(), static_cast<std::uint8_t>(side));
  frame.image = {frame.pixels->data(), width, height, stride, size, format};
  frame.exposure_us = 5000;
  stamped.utime_us = side == Side::kLeft ? 1'000'300 : 1'000'000;
  stamped.camera_us = 77;
  return stamped;
}

TEST(StereoCaptureMessagesTest, APairHasTheRightImagesTimeAndItsSkew) {
  ImagesMessage message(std::nullopt);
  const auto left = Frame(Side::kLeft, PixelFormat::kRgb, 8, 6);
  const auto right = Frame(Side::kRight, PixelFormat::kRgb, 8, 6);
  const images_t& images = message.Pair(left, right, 42);
  EXPECT_EQ(images.utime, 1'000'000);
  EXPECT_EQ(images.n_images, 2);
  EXPECT_EQ(images.image_types[0], images_t::LEFT);
  EXPECT_EQ(images.images[0].utime, 1'000'300);
  EXPECT_EQ(images.images[0].data[1], 1);
  EXPECT_EQ(images.images[1].data[1], 2);
  for (const image_t& image : images.images) {
    EXPECT_EQ(FindMetadata(image, "seq"), 42);
    EXPECT_EQ(FindMetadata(image, "skew_us"), 300);
    EXPECT_EQ(FindMetadata(image, "exposure_us"), 5000);
    EXPECT_EQ(FindMetadata(image, "camera_us"), 77);
    EXPECT_FALSE(FindMetadata(image, "gain_db"));  // unknown is absent, not 0
    EXPECT_EQ(image.size, 8 * 6 * 3);
  }
}

TEST(StereoCaptureMessagesTest, RawPicturesLendTheirMemoryAndHaveItBackUnchanged) {
  ImagesMessage message(std::nullopt);
  const auto left = Frame(Side::kLeft, PixelFormat::kGray, 8, 6);
  const auto right = Frame(Side::kRight, PixelFormat::kGray, 8, 6);
  const auto* memory = left.frame.pixels->data();
  const auto content = *left.frame.pixels;
  const images_t& images = message.Pair(left, right, 1);
  EXPECT_EQ(images.images[0].data.data(), memory);
  EXPECT_EQ(images.images[0].data, content);
  message.GiveBack();
  EXPECT_EQ(left.frame.pixels->data(), memory);
  EXPECT_EQ(*left.frame.pixels, content);
  EXPECT_EQ(left.frame.pixels.use_count(), 1);
}

TEST(StereoCaptureMessagesTest, TheNextMessageGivesBackWhatTheLastBorrowed) {
  ImagesMessage message(std::nullopt);
  const auto left = Frame(Side::kLeft, PixelFormat::kGray, 8, 6);
  const auto right = Frame(Side::kRight, PixelFormat::kGray, 8, 6);
  const auto* memory = right.frame.pixels->data();
  message.Pair(left, right, 1);
  const images_t& single = message.Single(left, 2);
  EXPECT_EQ(right.frame.pixels->data(), memory);
  EXPECT_EQ(single.n_images, 1);
  EXPECT_EQ(single.utime, left.utime_us);
  EXPECT_EQ(single.image_types[0], images_t::LEFT);
  EXPECT_FALSE(FindMetadata(single.images[0], "skew_us"));
  message.Single(right, 3);
}

TEST(StereoCaptureMessagesTest, APictureThatItsMemoryExceedsIsCopied) {
  ImagesMessage message(std::nullopt);
  const auto left = Frame(Side::kLeft, PixelFormat::kGray, 8, 6, 100);
  const images_t& single = message.Single(left, 2);
  EXPECT_NE(single.images[0].data.data(), left.frame.pixels->data());
  EXPECT_EQ(single.images[0].size, 48);
  EXPECT_EQ(FromMessage(single.images[0]).width, 8);
}

TEST(StereoCaptureMessagesTest, JpegIsMadeOfGreyColourAndBayer) {
  ImagesMessage message(80);
  for (const auto format : {PixelFormat::kGray, PixelFormat::kRgb, PixelFormat::kBgr,
                            PixelFormat::kBayerRggb, PixelFormat::kBayerBggr}) {
    const auto frame = Frame(Side::kRight, format, 32, 16);
    const images_t& single = message.Single(frame, 2);
    const ImageView image = FromMessage(single.images[0]);
    EXPECT_EQ(image.format, PixelFormat::kJpeg);
    EXPECT_EQ(image.width, 32);
    ImageDecoder decoder;
    EXPECT_EQ(decoder.Decode(image).height, 16) << PixelFormatName(format);
    EXPECT_EQ(frame.frame.pixels.use_count(), 1);
  }
}

}  // namespace
}  // namespace visavis
