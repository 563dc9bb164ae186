#include "services/log_tool/picture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/sequence_folder.h"

namespace visavis {
namespace {

using ::testing::StartsWith;
using Bytes = std::vector<std::uint8_t>;

class PictureFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return folder_ / name;
  }
  static ImageView View(const Bytes& pixels, int width, int height, PixelFormat format) {
    return {pixels.data(), width, height, width * BytesPerPixel(format), pixels.size(), format};
  }
  static Bytes Content(const ImageView& image) { return {image.data, image.data + image.size}; }

  const TemporaryFolder folder_;
  ImageDecoder decoder_;
};

TEST_F(PictureFileTest, WhatIsWrittenWithoutLossReadsAsItWas) {
  for (const PixelFormat format : {PixelFormat::kGray, PixelFormat::kRgb}) {
    const bool grey = format == PixelFormat::kGray;
    const Bytes pixels = MakePixels(9, 7, grey, 4);
    EXPECT_EQ(WritePicture(View(pixels, 9, 7, format), folder_ / "p", &decoder_), ".png");
    PictureReader reader;
    const ImageView image = reader.Read(folder_ / "p.png", 9, 7);
    EXPECT_EQ(image.format, format);
    EXPECT_EQ(Content(image), pixels);
  }
}

TEST_F(PictureFileTest, BgrIsWrittenAsTheSamePictureInRgb) {
  const Bytes bgr{10, 20, 30, 40, 50, 60};
  WritePicture(View(bgr, 2, 1, PixelFormat::kBgr), folder_ / "p", &decoder_);
  PictureReader reader;
  EXPECT_EQ(Content(reader.Read(folder_ / "p.png", 2, 1)), (Bytes{30, 20, 10, 60, 50, 40}));
}

TEST_F(PictureFileTest, RowsWithAGapBehindThemAreWrittenWithoutIt) {
  const Bytes rows{1, 2, 99, 99, 3, 4};  // 2x2 with a stride of 4
  WritePicture({rows.data(), 2, 2, 4, rows.size(), PixelFormat::kGray}, folder_ / "p", &decoder_);
  PictureReader reader;
  EXPECT_EQ(Content(reader.Read(folder_ / "p.png", 2, 2)), (Bytes{1, 2, 3, 4}));
}

TEST_F(PictureFileTest, AJpegStaysItsBytesWhateverItsName) {
  const std::string jpeg = MakeJpeg(16, 8), path = Write("p.png", jpeg);
  PictureReader reader;
  const ImageView image = reader.Read(path, 16, 8);
  EXPECT_EQ(image.format, PixelFormat::kJpeg);
  EXPECT_EQ(Content(image), Bytes(jpeg.begin(), jpeg.end()));
  EXPECT_EQ(WritePicture(image, folder_ / "copy", &decoder_), ".jpg");
  std::ifstream copy(folder_ / "copy.jpg", std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(copy), {}), jpeg);
}

TEST_F(PictureFileTest, AFileNamedTwiceInARowIsReadOnce) {
  const std::string path = Write("p.ppm", MakePnm(8, 6, false, 1));
  PictureReader reader;
  const Bytes first = Content(reader.Read(path, 8, 6));
  Write("p.ppm", "now something else");
  EXPECT_EQ(Content(reader.Read(path, 8, 6)), first);
  EXPECT_THROW(PictureReader().Read(path, 8, 6), std::invalid_argument);
}

TEST_F(PictureFileTest, AFailedReadIsNotRemembered) {
  PictureReader reader;
  EXPECT_THROW(reader.Read(Write("p.ppm", "no picture"), 8, 6), std::invalid_argument);
  EXPECT_NO_THROW(reader.Read(Write("p.ppm", MakePnm(8, 6, false, 1)), 8, 6));
}

TEST_F(PictureFileTest, SixteenBitsAChannelAreRefused) {
  const std::string path = Write("p.pgm", "P5\n2 1\n65535\n" + std::string(4, 'x'));
  PictureReader reader;
  EXPECT_THAT([&] { reader.Read(path, 2, 1); }, ::testing::ThrowsMessage<std::invalid_argument>(
                                                    StartsWith("must have 8 bits a channel")));
}

TEST_F(PictureFileTest, AFileThatCannotBeWrittenIsNamed) {
  const Bytes pixels = MakePixels(2, 2, true, 1);
  EXPECT_THAT(
      [&] { WritePicture(View(pixels, 2, 2, PixelFormat::kGray), folder_ / "no/p", &decoder_); },
      ::testing::ThrowsMessage<std::runtime_error>(folder_ / "no/p.png" +
                                                   ": No such file or directory"));
}

}  // namespace
}  // namespace visavis
