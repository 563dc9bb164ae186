#include "common/convert/image_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

#include "common/convert/message_error.h"
#include "common/core/random.h"

namespace visavis {
namespace {

using ::testing::ThrowsMessage;

constexpr std::int32_t kFormats[] = {
    image_t::PIXELFORMAT_GRAY,       image_t::PIXELFORMAT_RGB,
    image_t::PIXELFORMAT_BGR,        image_t::PIXELFORMAT_BAYER_BGGR,
    image_t::PIXELFORMAT_BAYER_GBRG, image_t::PIXELFORMAT_BAYER_GRBG,
    image_t::PIXELFORMAT_BAYER_RGGB, image_t::PIXELFORMAT_MJPEG};

auto Refuses(const std::string& line) { return ThrowsMessage<MessageError>(line); }

image_t GrayImage(int width = 4, int height = 3, int stride = 5) {
  image_t m{};
  m.utime = 1000;
  m.width = width;
  m.height = height;
  m.row_stride = stride;
  m.pixelformat = image_t::PIXELFORMAT_GRAY;
  m.size = stride * height;
  m.data.resize(static_cast<std::size_t>(m.size));
  std::iota(m.data.begin(), m.data.end(), std::uint8_t{0});
  return m;
}

images_t Pair() {
  images_t m{};
  m.utime = 1000;
  m.n_images = 2;
  m.image_types = {images_t::LEFT, images_t::RIGHT};
  m.images = {GrayImage(6, 3, 6), GrayImage()};
  AddMetadata("seq", 41, &m.images[1]);
  return m;
}

StereoRig Rig() {
  StereoRig rig;
  rig.right = {4, 3, 10, 10, 2, 1.5, {}};
  rig.left = {6, 3, 10, 10, 3, 1.5, {}};
  return rig;
}

TEST(ImageMessageTest, AViewIsTheMessagesOwnMemory) {
  const image_t m = GrayImage();
  const ImageView view = FromMessage(m);
  EXPECT_EQ(view.data, m.data.data());
  EXPECT_EQ(view.width, 4);
  EXPECT_EQ(view.height, 3);
  EXPECT_EQ(view.stride, 5);
  EXPECT_EQ(view.size, 15u);
  EXPECT_EQ(view.row(2)[1], 11);
}

TEST(ImageMessageTest, EveryFormatMakesTheRoundTrip) {
  std::vector<std::uint8_t> bytes(20 * 3, 7);
  for (int i = 0; i < 8; ++i) {
    const auto format = static_cast<PixelFormat>(i);
    const int stride = format == PixelFormat::kJpeg ? 0 : 20;
    image_t m;
    SetImage({bytes.data(), 4, 3, stride, bytes.size(), format}, 99, &m);
    const ImageView view = FromMessage(m);
    EXPECT_EQ(view.format, format);
    EXPECT_EQ(view.stride, stride);
    EXPECT_EQ(view.size, bytes.size());
    EXPECT_EQ(m.data, bytes);
    EXPECT_EQ(m.size, static_cast<std::int32_t>(bytes.size()));
    EXPECT_EQ(m.utime, 99);
  }
}

TEST(ImageMessageTest, SetImageReplacesAllThatWasThere) {
  image_t m = GrayImage(100, 100, 100);
  AddMetadata("seq", 3, &m);
  const std::vector<std::uint8_t> bytes{1, 2, 3, 4, 5, 6};
  SetImage({bytes.data(), 1, 2, 3, 6, PixelFormat::kRgb}, 5, &m);
  EXPECT_EQ(m.data, bytes);
  EXPECT_EQ(m.nmetadata, 0);
  EXPECT_TRUE(m.metadata.empty());
}

// A view into a larger picture ends at its last pixel: behind that may be nobody's memory.
TEST(ImageMessageTest, SetImageReadsNothingBehindTheView) {
  const std::vector<std::uint8_t> bytes{1, 2, 9, 3, 4};
  image_t m;
  SetImage({bytes.data(), 2, 2, 3, bytes.size(), PixelFormat::kGray}, 0, &m);
  EXPECT_EQ(m.data, (std::vector<std::uint8_t>{1, 2, 9, 3, 4, 0}));
  EXPECT_EQ(m.size, 6);
}

TEST(ImageMessageTest, ALyingFieldIsNamedWithValueAndRule) {
  const auto refusal = [](const std::function<void(image_t*)>& spoil) {
    image_t m = GrayImage();
    spoil(&m);
    try {
      FromMessage(m);
    } catch (const MessageError& e) {
      return std::string(e.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refusal([](image_t*) {}), "taken");
  EXPECT_EQ(refusal([](image_t* m) { m->utime = -1; }), "image_t.utime: -1: must be >= 0");
  EXPECT_EQ(refusal([](image_t* m) { m->width = 0; }), "image_t.width: 0: must be 1 to 16384 px");
  EXPECT_EQ(refusal([](image_t* m) { m->height = 16385; }),
            "image_t.height: 16385: must be 1 to 16384 px");
  EXPECT_EQ(refusal([](image_t* m) { m->pixelformat = 7; }),
            "image_t.pixelformat: 7: must be GRAY, RGB, BGR, MJPEG or a BAYER pattern");
  EXPECT_EQ(refusal([](image_t* m) { m->row_stride = 3; }),
            "image_t.row_stride: 3: must be at least width times bytes a pixel");
  EXPECT_EQ(refusal([](image_t* m) { m->row_stride = std::numeric_limits<int>::max(); }),
            "image_t.size: 15: must be at least row_stride times height");
  EXPECT_EQ(refusal([](image_t* m) { m->data.resize(13); }),
            "image_t.size: 13: must be at least row_stride times height");
  EXPECT_EQ(refusal([](image_t* m) { m->data.resize(14); }), "taken");  // to the last pixel
  EXPECT_EQ(refusal([](image_t* m) {
              m->pixelformat = image_t::PIXELFORMAT_MJPEG;
              m->data.resize(3);
            }),
            "image_t.size: 3: must hold a JPEG");
}

TEST(StereoMessageTest, PicturesAreFoundByTypeNotByOrder) {
  images_t m = Pair();
  for (int turn = 0; turn < 2; ++turn) {
    const StereoImages images = FromMessage(m, Rig());
    ASSERT_TRUE(images.left && images.right);
    EXPECT_EQ(images.left->width, 6);
    EXPECT_EQ(images.right->width, 4);
    EXPECT_EQ(images.utime_us, 1000);
    EXPECT_EQ(images.seq, 41);
    std::swap(m.images[0], m.images[1]);
    std::swap(m.image_types[0], m.image_types[1]);
  }
}

TEST(StereoMessageTest, OneCameraAloneIsAccepted) {
  images_t m = Pair();
  m.n_images = 1;
  m.images.pop_back();
  m.image_types.pop_back();
  const StereoImages images = FromMessage(m, Rig());
  EXPECT_TRUE(images.left.has_value());
  EXPECT_FALSE(images.right.has_value());
  EXPECT_FALSE(images.seq.has_value());
}

TEST(StereoMessageTest, RefusesWrongTypesTimesAndSizes) {
  images_t m = Pair();
  m.utime = -5;
  EXPECT_THAT([&] { FromMessage(m, Rig()); }, Refuses("images_t.utime: -5: must be >= 0"));
  m = Pair();
  m.image_types[1] = 4;
  EXPECT_THAT([&] { FromMessage(m, Rig()); },
              Refuses("images_t.image_types: 4: must be 0 (left) or 1 (right)"));
  m = Pair();
  m.image_types[1] = images_t::LEFT;
  EXPECT_THAT([&] { FromMessage(m, Rig()); },
              Refuses("images_t.image_types: 0: must not come twice"));
  m = Pair();
  m.image_types.pop_back();
  EXPECT_THAT([&] { FromMessage(m, Rig()); },
              Refuses("images_t.image_types: 1: must be as many as images"));
  EXPECT_THAT([&] { FromMessage(images_t{}, Rig()); },
              Refuses("images_t.n_images: 0: must be 1 or 2"));
  m = Pair();
  m.images[1] = GrayImage(5, 3, 5);
  EXPECT_THAT([&] { FromMessage(m, Rig()); },
              Refuses("right image: 5x3: must be 4x3 as in the rig"));
}

TEST(MetadataTest, NumbersMakeTheRoundTrip) {
  image_t m = GrayImage();
  const std::int64_t values[] = {0, -17, std::numeric_limits<std::int64_t>::max(),
                                 std::numeric_limits<std::int64_t>::min()};
  for (const auto value : values) AddMetadata("key" + std::to_string(value), value, &m);
  EXPECT_EQ(m.nmetadata, 4);
  for (const auto value : values) {
    EXPECT_EQ(FindMetadata(m, "key" + std::to_string(value)), value);
  }
}

TEST(MetadataTest, WhatIsMissingOrNoNumberIsNothing) {
  image_t m = GrayImage();
  EXPECT_EQ(FindMetadata(m, "seq"), std::nullopt);
  for (const std::string text : {"", "12x", "x", "1.5", "99999999999999999999"}) {
    image_metadata_t entry;
    entry.key = "seq";
    entry.value.assign(text.begin(), text.end());
    m.metadata = {entry};
    EXPECT_EQ(FindMetadata(m, "seq"), std::nullopt) << text;
  }
}

// What decodes may hold anything: it is taken, and then every pixel is readable, or it is refused.
TEST(StereoMessageTest, AnyValuesAreTakenOrRefusedByName) {
  Random random(1);
  int taken = 0, refused = 0;
  std::int64_t sum = 0;
  const auto any = [&](std::int32_t usual) {
    const std::int32_t odd[] = {-1,
                                0,
                                1,
                                16384,
                                16385,
                                std::numeric_limits<std::int32_t>::max(),
                                std::numeric_limits<std::int32_t>::min()};
    return random.Index(8) == 0 ? odd[random.Index(7)] : usual;
  };
  for (int i = 0; i < 20000; ++i) {
    images_t m = Pair();
    m.utime = any(5);
    for (auto& type : m.image_types) type = static_cast<std::int16_t>(any(type));
    for (auto& image : m.images) {
      image.width = any(image.width);
      image.height = any(image.height);
      image.row_stride = any(image.row_stride);
      image.pixelformat = any(kFormats[random.Index(8)]);
      image.data.resize(static_cast<std::size_t>(random.Index(80)));
    }
    try {
      const StereoImages images = FromMessage(m, Rig());
      for (const auto& view : {images.left, images.right}) {
        if (!view || view->format == PixelFormat::kJpeg) continue;
        for (int y = 0; y < view->height; ++y) {
          sum += std::accumulate(view->row(y),
                                 view->row(y) + view->width * BytesPerPixel(view->format), 0);
        }
      }
      ++taken;
    } catch (const MessageError& e) {
      EXPECT_NE(std::string(e.what()).find(": must"), std::string::npos) << e.what();
      ++refused;
    }
  }
  EXPECT_GT(taken, 100);
  EXPECT_GT(refused, 1000);
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace visavis
