#include "common/gige/fake_camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstring>

#include "common/core/clock.h"
#include "common/gige/gobject.h"
#include "tests/support/private_network.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// The frame's number in its first bytes.
std::optional<std::int64_t> WriteNumber(const FakeFrame& frame) {
  std::memset(frame.pixels, 0, static_cast<std::size_t>(frame.width) * frame.height);
  std::memcpy(frame.pixels, &frame.number, sizeof frame.number);
  return std::nullopt;
}

struct Received {
  std::uint64_t number{0};
  std::int64_t camera_ns{0};
  std::int64_t arrival_us{0};
  int width{0}, height{0};
  ArvPixelFormat format{0};
};

/// A plain client of Aravis's.
class Client {
 public:
  explicit Client(const char* address) {
    GlibError error;
    const ObjectPtr<GInetAddress> at(g_inet_address_new_from_string(address));
    ArvDevice* device = arv_gv_device_new(at.get(), at.get(), error.out());
    if (!device) return;
    camera_.reset(arv_camera_new_with_device(device, error.out()));
    g_object_unref(device);
  }
  ~Client() {
    if (stream_) arv_camera_stop_acquisition(camera_.get(), nullptr);
  }

  ArvCamera* camera() const { return camera_.get(); }

  void Start(double frame_rate_hz) {
    arv_camera_set_frame_rate(camera_.get(), frame_rate_hz, nullptr);
    arv_camera_gv_set_packet_size(camera_.get(), 9000, nullptr);
    arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, nullptr));
    g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                 "socket-buffer-size", 4'000'000, nullptr);
    const auto payload = arv_camera_get_payload(camera_.get(), nullptr);
    for (int i = 0; i < 5; ++i)
      arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload, nullptr));
    arv_camera_start_acquisition(camera_.get(), nullptr);
  }

  /// The next whole frame; nothing if none comes in @p seconds.
  std::optional<Received> Next(double seconds = 3) {
    const double end_s = MonotonicSeconds() + seconds;
    while (MonotonicSeconds() < end_s) {
      ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), 20'000);
      if (!buffer) continue;
      const bool good = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS;
      Received frame;
      frame.camera_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer));
      frame.arrival_us = static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer) / 1000);
      if (good) {
        std::memcpy(&frame.number, arv_buffer_get_data(buffer, nullptr), sizeof frame.number);
        frame.width = arv_buffer_get_image_width(buffer);
        frame.height = arv_buffer_get_image_height(buffer);
        frame.format = arv_buffer_get_image_pixel_format(buffer);
      }
      arv_stream_push_buffer(stream_.get(), buffer);
      if (good) return frame;
    }
    return std::nullopt;
  }

 private:
  ObjectPtr<ArvCamera> camera_;
  ObjectPtr<ArvStream> stream_;
};

class FakeCameraTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
  }
  FakeCamera::Options options_{"127.0.0.1", "LEFT", 160, 120, PixelFormat::kGray, 100};
};

TEST_F(FakeCameraTest, OurPicturesArriveInOrderWithTheSizeAndFormatOfPowerOn) {
  options_.format = PixelFormat::kBayerRggb;
  FakeCamera camera(options_, WriteNumber);
  Client client("127.0.0.1");
  ASSERT_TRUE(client.camera());
  EXPECT_STREQ(arv_camera_get_device_serial_number(client.camera(), nullptr), "LEFT");
  client.Start(100);
  auto frame = client.Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->width, 160);
  EXPECT_EQ(frame->height, 120);
  EXPECT_EQ(frame->format, static_cast<ArvPixelFormat>(ARV_PIXEL_FORMAT_BAYER_RG_8));
  for (int i = 0; i < 20; ++i) {
    const auto next = client.Next();
    ASSERT_TRUE(next);
    EXPECT_EQ(next->number, frame->number + 1);
    frame = next;
  }
}

TEST_F(FakeCameraTest, TheCallbackLearnsTheClientsSettingsAndSetsTheTime) {
  std::atomic<double> exposure_us{0};
  FakeCamera camera(options_, [&](const FakeFrame& frame) -> std::optional<std::int64_t> {
    exposure_us = frame.exposure_us;
    WriteNumber(frame);
    return frame.utime_us - 50'000;
  });
  const auto power_on_us = SystemClock().NowUs();
  Client client("127.0.0.1");
  arv_camera_set_exposure_time(client.camera(), 2500, nullptr);
  client.Start(100);
  const auto frame = client.Next();
  ASSERT_TRUE(frame);
  EXPECT_EQ(exposure_us, 2500);
  // 50 ms before it was sent, by a clock that began at power-on, give or take a slow link.
  EXPECT_NEAR(1e-3 * static_cast<double>(frame->camera_ns),
              static_cast<double>(frame->arrival_us - power_on_us) - 50'000, 20'000);
}

TEST_F(FakeCameraTest, TheClockHasAnOffsetDriftsAndCanBeSet) {
  options_.clock_start_s = 1000;
  options_.drift_ppm = 100'000;  // 10 %: seen in a tenth of a second
  FakeCamera camera(options_, [](const FakeFrame& frame) -> std::optional<std::int64_t> {
    WriteNumber(frame);
    std::memcpy(frame.pixels + 8, &frame.utime_us, sizeof frame.utime_us);
    return frame.utime_us;
  });
  Client client("127.0.0.1");
  client.Start(100);
  const auto first = client.Next();
  std::optional<Received> last;
  for (int i = 0; i < 20; ++i) last = client.Next();
  ASSERT_TRUE(first && last);
  EXPECT_GT(first->camera_ns, 1'000'000'000'000);
  const auto camera_us = 1e-3 * static_cast<double>(last->camera_ns - first->camera_ns);
  const auto host_us = static_cast<double>(last->arrival_us - first->arrival_us);
  EXPECT_NEAR(camera_us, 1.1 * host_us, 5000);
  EXPECT_GT(camera_us, 1.1 * 180'000);  // 20 frames of 10 ms
  camera.StepClock(-500);
  for (int i = 0; i < 3; ++i) last = client.Next();
  EXPECT_LT(last->camera_ns, 600'000'000'000);
}

TEST_F(FakeCameraTest, AFrozenCameraNeitherSendsNorAnswersUntilItThaws) {
  FakeCamera camera(options_, WriteNumber);
  Client client("127.0.0.1");
  client.Start(100);
  ASSERT_TRUE(client.Next());
  camera.Freeze();
  while (client.Next(0.1)) {
  }
  const auto made = camera.num_frames();
  EXPECT_FALSE(client.Next(0.2));
  EXPECT_EQ(camera.num_frames(), made);
  camera.Thaw();
  EXPECT_TRUE(client.Next());
}

TEST_F(FakeCameraTest, AMutedCameraAnswersAndItsFramesAreLost) {
  FakeCamera camera(options_, WriteNumber);
  Client client("127.0.0.1");
  client.Start(100);
  auto before = client.Next();
  ASSERT_TRUE(before);
  camera.Mute();
  while (const auto frame = client.Next(0.1)) before = frame;
  GlibError error;
  arv_camera_get_exposure_time(client.camera(), error.out());
  EXPECT_FALSE(error) << error.message();
  camera.Unmute();
  const auto after = client.Next();
  ASSERT_TRUE(after);
  EXPECT_GT(after->number, before->number + 8);
}

TEST_F(FakeCameraTest, DroppedFramesAreMissingAndNoOthers) {
  FakeCamera camera(options_, WriteNumber);
  Client client("127.0.0.1");
  client.Start(100);
  auto last = client.Next();
  ASSERT_TRUE(last);
  camera.Drop(3);
  std::uint64_t missing = 0;
  for (int i = 0; i < 20; ++i) {
    const auto next = client.Next();
    ASSERT_TRUE(next);
    missing += next->number - last->number - 1;
    last = next;
  }
  EXPECT_EQ(missing, 3u);
}

TEST_F(FakeCameraTest, ItDiesAndReturnsElsewhereWithClockAndNumbersAnew) {
  FakeCamera camera(options_, WriteNumber);
  {
    Client client("127.0.0.1");
    client.Start(100);
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(client.Next());
  }
  camera.Die();
  EXPECT_FALSE(camera.powered());
  camera.Return("127.0.0.2");
  EXPECT_TRUE(camera.powered());
  Client client("127.0.0.2");
  ASSERT_TRUE(client.camera());
  client.Start(100);
  const auto frame = client.Next();
  ASSERT_TRUE(frame);
  EXPECT_LT(frame->number, 5u);
  EXPECT_LT(frame->camera_ns, 2'000'000'000);
  camera.Return();
  EXPECT_TRUE(camera.powered());
}

TEST_F(FakeCameraTest, AnAddressThatIsTakenOrNotOursIsRefused) {
  const FakeCamera camera(options_, WriteNumber);
  EXPECT_THAT([&] { FakeCamera(options_, WriteNumber); },
              ThrowsMessage<std::runtime_error>(HasSubstr("127.0.0.1:3956: Address already")));
  options_.address = "192.0.2.1";
  EXPECT_THAT([&] { FakeCamera(options_, WriteNumber); },
              ThrowsMessage<std::runtime_error>(HasSubstr("192.0.2.1:3956: Cannot assign")));
  options_.address = "nonsense";
  EXPECT_THROW(FakeCamera(options_, WriteNumber), std::runtime_error);
}

}  // namespace
}  // namespace visavis
