#include "services/stereo_capture/aravis_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "common/core/clock.h"
#include "common/core/random.h"
#include "common/gige/fake_camera.h"
#include "services/stereo_capture/aravis_connection.h"
#include "services/stereo_capture/sources.h"
#include "tests/services/stereo_capture/gvsp_sender.h"
#include "tests/support/private_network.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using State = CameraReport::State;

std::optional<std::int64_t> WriteNumber(const FakeFrame& frame) {
  std::memcpy(frame.pixels, &frame.number, sizeof frame.number);
  return std::nullopt;
}

class AravisCameraTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
    config_.pixel_format = "Mono8";
    config_.frame_rate_hz = 100;
    config_.packet_size_bytes = 1008;  // 20 frame rows of pixels fit, see below
  }

  FakeCamera& PowerOn(FillFrame fill) {
    fake_ = std::make_unique<FakeCamera>(options_, std::move(fill));
    return *fake_;
  }
  void Open(const std::string& name = "LEFT", std::optional<PictureSize> rig_size = {}) {
    camera_ = std::make_unique<AravisCamera>(Side::kLeft, SideConfig{name, features_}, config_,
                                             rig_size, &queue_);
  }
  bool WaitFor(const std::function<bool()>& condition, double seconds = 5) const {
    const double end_s = MonotonicSeconds() + seconds;
    while (MonotonicSeconds() < end_s) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return condition();
  }
  bool WaitForFrames(int count) {
    int frames = 0;
    return WaitFor([&] {
      while (queue_.Pop()) ++frames;
      return frames >= count;
    });
  }
  std::string WaitForRefusal() {
    WaitFor([&] { return camera_->Report().state == State::kRefused; });
    EXPECT_EQ(camera_->Report().state, State::kRefused);
    return camera_->Report().text;
  }

  FakeCamera::Options options_{"127.0.0.1", "LEFT", 160, 120, PixelFormat::kGray, 100};
  CameraConfig config_;
  std::map<std::string, std::string> features_;
  FrameQueue queue_{64};
  std::unique_ptr<FakeCamera> fake_;
  std::unique_ptr<AravisCamera> camera_;  // after fake_: it says farewell first
};

// Aravis asks a fake camera that another holds again and again, for 8 s.
TEST_F(AravisCameraTest, TheListTellsThatAnotherProgramHoldsTheCamera) {
  PowerOn(WriteNumber);
  const auto found = FindCameras("LEFT", 500, "");
  ASSERT_EQ(found.size(), 1u);
  AravisConnection holder(found[0]);
  ASSERT_TRUE(holder.TakeControl());
  EXPECT_THAT(ListCameras(), HasSubstr("LEFT at 127.0.0.1\n  another program holds it\n"));
}

TEST_F(AravisCameraTest, FramesComeInOrderWithNumberTimesAndExposure) {
  PowerOn(WriteNumber);
  config_.exposure = "fixed";
  config_.exposure_ms = 2;
  Open();
  std::optional<std::uint64_t> last;
  int taken = 0;
  EXPECT_TRUE(WaitFor([&] {
    while (auto frame = queue_.Pop()) {
      std::uint64_t number = 0;
      std::memcpy(&number, frame->image.data, sizeof number);
      EXPECT_EQ(number, last.value_or(number - 1) + 1);
      last = number;
      EXPECT_EQ(frame->image.width, 160);
      EXPECT_EQ(frame->image.size, 160u * 120u);
      EXPECT_EQ(frame->exposure_us, 2000);
      EXPECT_NEAR(static_cast<double>(SystemClock().NowUs() - frame->arrival_us), 0, 500'000);
      ++taken;
    }
    return taken > 20;
  }));
  const CameraReport report = camera_->Report();
  EXPECT_EQ(report.state, State::kStreaming);
  EXPECT_EQ(report.connects, 1);
  EXPECT_THAT(report.what,
              HasSubstr("Aravis Fake LEFT at 127.0.0.1, 160x120 Mono8, 2 ms, packets"));
}

TEST_F(AravisCameraTest, RegionFormatAndFeaturesReachTheCamera) {
  FakeCamera& fake = PowerOn(WriteNumber);
  config_.pixel_format = "BayerGR8";
  config_.width_px = 64;
  config_.height_px = 48;
  config_.offset_x_px = 16;
  config_.offset_y_px = 8;
  config_.gain = "fixed";
  config_.gain_db = 4;
  features_ = {{"BinningVertical", "2"}, {"TestRegister", "77"}};
  Open("Aravis-Fake-LEFT");
  ASSERT_TRUE(WaitForFrames(3));
  EXPECT_EQ(fake.ReadRegister(ARV_FAKE_CAMERA_REGISTER_X_OFFSET), 16u);
  EXPECT_EQ(fake.ReadRegister(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET), 8u);
  EXPECT_EQ(fake.ReadRegister(ARV_FAKE_CAMERA_REGISTER_GAIN_RAW), 4u);
  EXPECT_EQ(fake.ReadRegister(ARV_FAKE_CAMERA_REGISTER_BINNING_VERTICAL), 2u);
  EXPECT_EQ(fake.ReadRegister(ARV_FAKE_CAMERA_REGISTER_TEST), 77u);
  std::optional<CapturedFrame> frame;
  ASSERT_TRUE(WaitFor([&] { return (frame = queue_.Pop()).has_value(); }));
  EXPECT_EQ(frame->image.format, PixelFormat::kBayerGrbg);
  EXPECT_EQ(frame->image.width, 64);
}

TEST_F(AravisCameraTest, AUserWhoKeepsTheCamerasSettingsHasThemKept) {
  options_.format = PixelFormat::kBayerGbrg;
  PowerOn(WriteNumber);
  config_.pixel_format = "keep";
  Open();
  std::optional<CapturedFrame> frame;
  ASSERT_TRUE(WaitFor([&] { return (frame = queue_.Pop()).has_value(); }));
  EXPECT_EQ(frame->image.format, PixelFormat::kBayerGbrg);
  EXPECT_EQ(frame->image.width, 160);
}

TEST_F(AravisCameraTest, WhatTheCameraCannotDoIsRefusedWithKeyValueAndRule) {
  PowerOn(WriteNumber);
  const auto refusal = [&](const std::function<void()>& change) {
    const CameraConfig before = config_;
    change();
    Open();
    const std::string text = WaitForRefusal();
    camera_.reset();
    config_ = before;
    features_.clear();
    return text;
  };
  EXPECT_THAT(refusal([&] { config_.gain = "fixed", config_.gain_db = 50; }),
              HasSubstr("left camera: camera.gain_db: 50: this camera takes 0 to 10"));
  EXPECT_THAT(refusal([&] { config_.exposure = "auto"; }),
              HasSubstr("camera.exposure: auto: this camera has no such thing"));
  EXPECT_THAT(refusal([&] { config_.white_balance = "fixed"; }),
              HasSubstr("camera.white_balance: fixed: this camera has no BalanceRatio"));
  EXPECT_THAT(refusal([&] {
                features_ = {{"NoSuchThing", "1"}};
              }),
              HasSubstr("features.NoSuchThing: 1: this camera has no such feature"));
  EXPECT_THAT(refusal([&] {
                features_ = {{"TriggerSource", "Line9"}};
              }),
              HasSubstr("features.TriggerSource: Line9: "));
  EXPECT_THAT(refusal([&] {
                features_ = {{"PixelFormat", "Mono16"}};
              }),
              HasSubstr("this camera is set to Mono16, must be an 8-bit"));
  Open("LEFT", PictureSize{640, 480});
  EXPECT_THAT(WaitForRefusal(), HasSubstr("rig_file: 640x480: this camera's pictures are 160x120"));
  EXPECT_FALSE(queue_.Pop());
}

TEST_F(AravisCameraTest, AnAddressWillDoAndAnUnknownNameIsLookedFor) {
  PowerOn(WriteNumber);
  Open("127.0.0.1");
  EXPECT_TRUE(WaitForFrames(3));
  Open("SOMEBODY");
  EXPECT_TRUE(WaitFor([&] { return camera_->Report().attempts > 1; }));
  EXPECT_EQ(camera_->Report().state, State::kSearching);
  EXPECT_THAT(camera_->Report().text,
              HasSubstr("left camera: left.device: SOMEBODY: no such camera answers"));
}

TEST_F(AravisCameraTest, ACameraThatAnotherProgramHoldsIsToldAndHadOnceItIsFree) {
  PowerOn(WriteNumber);
  const auto found = FindCameras("LEFT", 50, "");
  ASSERT_EQ(found.size(), 1u);
  auto other = std::make_unique<AravisConnection>(found[0]);
  ASSERT_TRUE(other->TakeControl());
  Open();
  EXPECT_TRUE(WaitFor(
      [&] { return camera_->Report().text.find("another program holds it") != std::string::npos; },
      8))
      << camera_->Report().text;
  other.reset();
  EXPECT_TRUE(WaitForFrames(3));
}

TEST_F(AravisCameraTest, ALineThatNobodyPullsIsSaidAndNotTakenForALoss) {
  FakeCamera& fake = PowerOn(WriteNumber);
  config_.trigger = "line";
  config_.stall_ms = 100;
  Open();
  EXPECT_TRUE(WaitFor([&] { return camera_->Report().text == "left camera: no trigger on Line0"; }))
      << camera_->Report().text;
  EXPECT_EQ(camera_->Report().stalls, 0);
  fake.Die();  // now it is a loss
  EXPECT_TRUE(WaitFor([&] { return camera_->Report().stalls == 1; }, 8));
  fake.Return();  // or saying farewell to it takes seconds
}

TEST_F(AravisCameraTest, ALossyLinkWithoutResendIsToldAndNeverPublished) {
  options_.lost_packet_share = 0.02;
  PowerOn([](const FakeFrame& frame) -> std::optional<std::int64_t> {
    std::memset(frame.pixels, 9, static_cast<std::size_t>(frame.width) * frame.height);
    return std::nullopt;
  });
  Open();
  int good = 0;
  EXPECT_TRUE(WaitFor([&] {
    while (const auto frame = queue_.Pop()) {
      ++good;
      EXPECT_EQ(std::count(frame->pixels->begin(), frame->pixels->end(), 9), 160 * 120);
    }
    return camera_->Report().bad_frames >= 10 && good > 10;
  }));
  EXPECT_GT(camera_->Report().missing_packets, 0);
  EXPECT_THAT(camera_->Report().last_error, HasSubstr("left camera: frame"));
}

TEST_F(AravisCameraTest, PacketsAreAsLargeAsTheInterfaceTakesIfTheSizeIsLeftOpen) {
  config_.packet_size_bytes = 0;
  PowerOn(WriteNumber);
  Open();
  ASSERT_TRUE(WaitForFrames(3));
  EXPECT_THAT(camera_->Report().what, HasSubstr("packets of 9000 bytes"));
}

TEST_F(AravisCameraTest, ALinkThatLosesLargePacketsGetsSmallOnesAndKeepsThem) {
  config_.packet_size_bytes = 0;
  options_.largest_packet_bytes = 1500;
  FakeCamera& fake = PowerOn(WriteNumber);
  Open();
  ASSERT_TRUE(WaitForFrames(3));
  EXPECT_THAT(camera_->Report().what, HasSubstr("packets of 1400 bytes"));
  fake.Die();
  ASSERT_TRUE(WaitFor([&] { return camera_->Report().state != State::kStreaming; }));
  fake.Return();
  while (queue_.Pop()) continue;
  ASSERT_TRUE(WaitForFrames(3));
  EXPECT_THAT(camera_->Report().what, HasSubstr("packets of 1400 bytes"));
  EXPECT_EQ(camera_->Report().connects, 2);
}

// 160 x 120 grey in packets of 1008 bytes, 36 of them headers: 19 whole ones and 732 bytes.
constexpr int kPackets = 20;
constexpr std::size_t kPacketBytes = 972, kLastBytes = 160 * 120 - 19 * kPacketBytes;

TEST_F(AravisCameraTest, TruncatedAndLyingFramesAreNeverPublished) {
  FakeCamera& fake = PowerOn(WriteNumber);
  config_.stall_ms = 60'000;  // nobody shall connect anew meanwhile
  Open();
  ASSERT_TRUE(WaitForFrames(3));
  fake.Mute();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  while (queue_.Pop()) {
  }
  GvspSender sender("127.0.0.1", static_cast<int>(fake.ReadRegister(0xd00)));
  std::uint64_t time_ns = 100'000'000'000;  // ahead of the camera's clock, which begins at 0
  const auto code = static_cast<std::uint32_t>(ARV_PIXEL_FORMAT_MONO_8);
  const auto data = [&](int frame, int from, int to) {
    for (int p = from; p <= to; ++p)
      sender.Data(frame, p, p == kPackets ? kLastBytes : kPacketBytes);
  };
  const auto whole = [&](int frame, int width, int height, std::uint32_t pixel_format) {
    sender.Leader(frame, width, height, pixel_format, time_ns);
    data(frame, 1, kPackets);
    sender.Trailer(frame, kPackets + 1, height);
  };
  auto frame = static_cast<int>(fake.num_frames()) + 66'000;  // ahead of the camera's numbers
  const auto next = [&] {
    time_ns += 10'000'000;
    return ++frame % 65536;
  };

  const int truncated = next();  // ends after two packets
  sender.Leader(truncated, 160, 120, code, time_ns);
  data(truncated, 1, 2);
  sender.Trailer(truncated, 3, 120);
  const int hole = next();  // one packet is missing
  sender.Leader(hole, 160, 120, code, time_ns);
  data(hole, 1, 4);
  data(hole, 6, kPackets);
  sender.Trailer(hole, kPackets + 1, 120);
  whole(next(), 1600, 1200, code);                         // larger than it is
  whole(next(), 80, 120, code);                            // smaller
  whole(next(), 160, 120, ARV_PIXEL_FORMAT_RGB_8_PACKED);  // another format
  const int beyond = next();                               // packets past the end of the frame
  sender.Leader(beyond, 160, 120, code, time_ns);
  for (int p = kPackets; p < 1000; ++p) sender.Data(beyond, p, kPacketBytes);
  sender.Trailer(beyond, 0xffffff, 120);
  const int oversized = next();  // packets larger than agreed
  sender.Leader(oversized, 160, 120, code, time_ns);
  for (int p = 1; p <= kPackets; ++p) sender.Data(oversized, p, 8000);
  sender.Trailer(oversized, kPackets + 1, 120);
  Random random(3);
  for (int i = 0; i < 500; ++i) {  // noise, half of it under the name of data
    std::vector<std::uint8_t> noise(static_cast<std::size_t>(random.Index(60)));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.Index(256));
    if (noise.size() > 4) noise[4] = i % 2 ? 3 : 4;
    sender.Raw(noise);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(queue_.Pop());
  EXPECT_GT(camera_->Report().bad_frames, 0);

  // That they would have been taken, had they been right: the same made well. (Aravis may take what
  // the noise left of a frame for the beginning of the first.)
  frame += 2000;
  std::optional<CapturedFrame> taken;
  ASSERT_TRUE(WaitFor([&] {
    whole(next(), 160, 120, code);
    return WaitFor([&] { return (taken = queue_.Pop()).has_value(); }, 0.2);
  })) << camera_->Report().last_error;
  EXPECT_EQ(std::count(taken->pixels->begin(), taken->pixels->end(), 7), 160 * 120);
}

}  // namespace
}  // namespace visavis
