#include "services/simulator/gige_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "common/core/clock.h"
#include "common/gige/gobject.h"
#include "tests/support/private_network.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// ---- pixels ----

/// 2 x 2 pixels: red, green / blue, white.
const std::vector<std::uint8_t> kFour{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

std::vector<std::uint8_t> Filled(PixelFormat format, int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(BytesPerPixel(format) * width * height),
                                   77);
  FillFrameFromRgb(kFour, 2, 2, {0, 0, 33'333, 0, 0, format, width, height, pixels.data()});
  return pixels;
}

TEST(FillFrameTest, RgbStaysAsItIs) { EXPECT_EQ(Filled(PixelFormat::kRgb, 2, 2), kFour); }

TEST(FillFrameTest, GrayIsTheLuminance) {
  EXPECT_THAT(Filled(PixelFormat::kGray, 2, 2), ElementsAre(77, 149, 29, 255));
}

TEST(FillFrameTest, EachBayerPatternSamplesItsColour) {
  EXPECT_THAT(Filled(PixelFormat::kBayerRggb, 2, 2), ElementsAre(255, 255, 0, 255));
  EXPECT_THAT(Filled(PixelFormat::kBayerBggr, 2, 2), ElementsAre(0, 255, 0, 255));
  EXPECT_THAT(Filled(PixelFormat::kBayerGrbg, 2, 2), ElementsAre(0, 0, 255, 255));
  EXPECT_THAT(Filled(PixelFormat::kBayerGbrg, 2, 2), ElementsAre(0, 0, 0, 255));
}

TEST(FillFrameTest, ARegionIsTheUpperLeftPartAndBlackBeyond) {
  EXPECT_THAT(Filled(PixelFormat::kGray, 1, 1), ElementsAre(77));
  EXPECT_THAT(Filled(PixelFormat::kGray, 3, 3), ElementsAre(77, 149, 0, 29, 255, 0, 0, 0, 0));
}

// ---- cameras ----

struct Received {
  std::int64_t number{0}, camera_us{0};
};

/// A plain client of Aravis's.
class Client {
 public:
  explicit Client(const char* address) {
    camera_.reset(arv_camera_new(address, nullptr));
    arv_camera_gv_set_packet_size(camera_.get(), 9000, nullptr);
    arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, nullptr));
    const auto payload = arv_camera_get_payload(camera_.get(), nullptr);
    for (int i = 0; i < 5; ++i) {
      arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload, nullptr));
    }
    arv_camera_start_acquisition(camera_.get(), nullptr);
  }
  ~Client() { arv_camera_stop_acquisition(camera_.get(), nullptr); }

  std::optional<Received> Next() {
    ArvBuffer* buffer = arv_stream_try_pop_buffer(stream_.get());
    if (!buffer) return std::nullopt;
    std::optional<Received> frame;
    if (arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS) {
      frame.emplace();
      std::memcpy(&frame->number, arv_buffer_get_data(buffer, nullptr), sizeof frame->number);
      frame->camera_us = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer) / 1000);
    }
    arv_stream_push_buffer(stream_.get(), buffer);
    return frame;
  }

 private:
  ObjectPtr<ArvCamera> camera_;
  ObjectPtr<ArvStream> stream_;
};

class GigeCamerasTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
    rig_.right = rig_.left = {64, 48, 80, 80, 31.5, 23.5, {}};
  }

  StereoRig rig_;
  GigeConfig config_;
};

TEST_F(GigeCamerasTest, BothSendThePictureOfATickStampedByItsExposure) {
  GigeCameras cameras(config_, rig_, 30, 8);
  Client left("127.0.0.1"), right("127.0.0.2");
  const SystemClock clock;
  std::vector<std::int64_t> exposures_us;
  std::vector<Received> lefts, rights;
  std::int64_t due_us = cameras.NextTick(clock.NowUs());
  const double end_s = MonotonicSeconds() + 5;
  for (int shown = 0; MonotonicSeconds() < end_s && (lefts.size() < 5 || rights.size() < 5);) {
    if (clock.NowUs() >= due_us || shown == 0) {
      cameras.Update(0);
      due_us = cameras.NextTick(clock.NowUs());
      const auto picture = cameras.Blank();
      const auto number = static_cast<std::int64_t>(exposures_us.size());
      std::memcpy(picture->left.data(), &number, sizeof number);
      std::memcpy(picture->right.data(), &number, sizeof number);
      picture->due_us = due_us;
      picture->exposed_us = due_us - cameras.exposure_us() / 2;
      exposures_us.push_back(picture->exposed_us);
      cameras.Show(picture);
      ++shown;
    }
    if (const auto frame = left.Next()) lefts.push_back(*frame);
    if (const auto frame = right.Next()) rights.push_back(*frame);
  }
  ASSERT_GE(lefts.size(), 5u);
  ASSERT_GE(rights.size(), 5u);
  for (const auto& frames : {lefts, rights}) {
    for (const Received& frame : frames) {
      // The camera's clock began at power-on: differences alone can be known.
      const auto exposure = [&](const Received& f) {
        return exposures_us.at(static_cast<std::size_t>(f.number));
      };
      EXPECT_NEAR(static_cast<double>(frame.camera_us - frames[0].camera_us),
                  static_cast<double>(exposure(frame) - exposure(frames[0])), 1.0);
    }
  }
}

TEST_F(GigeCamerasTest, AFrameWithoutAPictureIsLost) {
  GigeCameras cameras(config_, rig_, 30, 8);
  Client left("127.0.0.1");
  const double end_s = MonotonicSeconds() + 5;
  while (cameras.num_lost() == 0 && MonotonicSeconds() < end_s) {
    EXPECT_FALSE(left.Next());
  }
  EXPECT_GE(cameras.num_lost(), 1);
}

TEST_F(GigeCamerasTest, FaultsBeginAndEndAtTheirTimes) {
  CameraFault fault;
  fault.camera = "right";
  fault.at_s = 1;
  fault.for_s = 2;
  fault.address = "127.0.0.3";
  config_.faults.push_back(fault);
  GigeCameras cameras(config_, rig_, 30, 8);
  cameras.Update(0.9);
  EXPECT_EQ(cameras.Faults(), "");
  cameras.Update(1);
  EXPECT_EQ(cameras.Faults(), "right: die");
  cameras.Update(3);
  EXPECT_EQ(cameras.Faults(), "");
  const Client returned("127.0.0.3");
}

TEST_F(GigeCamerasTest, AnAddressThatHasACameraIsRefused) {
  GigeCameras cameras(config_, rig_, 30, 8);
  EXPECT_THAT([&] { GigeCameras(config_, rig_, 30, 8); },
              ThrowsMessage<std::runtime_error>(HasSubstr("127.0.0.1:3956")));
}

TEST_F(GigeCamerasTest, PicturesLargerThanTheSensorAreRefused) {
  rig_.left.width = 2049;
  EXPECT_THAT([&] { GigeCameras(config_, rig_, 30, 8); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("2049 x 48 px")));
}

}  // namespace
}  // namespace visavis
