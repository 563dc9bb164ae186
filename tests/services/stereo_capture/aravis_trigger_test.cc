#include "services/stereo_capture/aravis_trigger.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "common/core/clock.h"
#include "common/gige/fake_camera.h"
#include "services/stereo_capture/aravis_connection.h"
#include "services/stereo_capture/aravis_error.h"
#include "tests/support/private_network.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::uint32_t kPtpEnable = 0x400, kLatch = 0x404, kLatchValue = 0x408, kDeviceKey = 0x410,
                        kGroupKey = 0x414, kGroupMask = 0x418;

std::string Register(const std::string& name, std::uint32_t address, int length) {
  return "<IntReg Name=\"" + name + "\"><Address>" + std::to_string(address) +
         "</Address><Length>" + std::to_string(length) +
         "</Length><AccessMode>RW</AccessMode><pPort>Device</pPort><Cachable>NoCache</Cachable>"
         "<Sign>Unsigned</Sign><Endianess>BigEndian</Endianess></IntReg>\n";
}

/// Aravis's description with PTP, a latch of the clock, and scheduled actions.
std::string GenicamWithActions() {
  std::string text = FakeCamera::GenicamText();
  const std::string entry = "<EnumEntry Name=\"Software\" NameSpace=\"Standard\">";
  text.insert(text.find(entry), "<EnumEntry Name=\"Action1\"><Value>2</Value></EnumEntry>");
  std::string more =
      "<Boolean Name=\"PtpEnable\"><pValue>PtpEnableReg</pValue></Boolean>\n"
      "<Command Name=\"TimestampLatch\"><pValue>LatchReg</pValue>"
      "<CommandValue>1</CommandValue></Command>\n";
  more += Register("PtpEnableReg", kPtpEnable, 4) + Register("LatchReg", kLatch, 4) +
          Register("TimestampLatchValue", kLatchValue, 8) +
          Register("ActionDeviceKey", kDeviceKey, 4) + Register("ActionGroupKey", kGroupKey, 4) +
          Register("ActionGroupMask", kGroupMask, 4);
  text.insert(text.find("<Port Name=\"Device\""), more);
  return text;
}

class AravisTriggerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
    std::ofstream(folder_ / "camera.xml") << GenicamWithActions();
    options_.genicam_file = folder_ / "camera.xml";
    config_.trigger = "action";
    config_.ptp = true;
    config_.frame_rate_hz = 50;
  }
  void Open() {
    fake_ = std::make_unique<FakeCamera>(options_, nullptr);
    const auto found = FindCameras("LEFT", 50, "");
    ASSERT_EQ(found.size(), 1u);
    connection_ = std::make_unique<AravisConnection>(found[0]);
  }

  const TemporaryFolder folder_;
  FakeCamera::Options options_{"127.0.0.1", "LEFT", 160, 120, PixelFormat::kRgb, 100};
  CameraConfig config_;
  std::unique_ptr<FakeCamera> fake_;
  std::unique_ptr<AravisConnection> connection_;
};

TEST_F(AravisTriggerTest, ACameraWithActionsIsSetToThem) {
  Open();
  ApplySettings(connection_->camera(), config_, {}, {});
  EXPECT_EQ(fake_->ReadRegister(kPtpEnable), 1u);
  EXPECT_EQ(fake_->ReadRegister(kDeviceKey), kActionKeys.device_key);
  EXPECT_EQ(fake_->ReadRegister(kGroupKey), kActionKeys.group_key);
  EXPECT_EQ(fake_->ReadRegister(kGroupMask), kActionKeys.group_mask);
  EXPECT_STREQ(arv_camera_get_trigger_source(connection_->camera(), nullptr), "Action1");
}

TEST_F(AravisTriggerTest, ACameraWithoutThemIsRefused) {
  options_.genicam_file.clear();
  Open();
  config_.ptp = false;  // it has no PTP either, which would be said first
  EXPECT_THAT([&] { ApplySettings(connection_->camera(), config_, {}, {}); },
              ThrowsMessage<CameraRefusal>(
                  HasSubstr("camera.trigger: action: this camera has no ActionDeviceKey")));
  AravisTrigger trigger(connection_->camera(), "127.0.0.1", config_);
  EXPECT_THAT([&] { trigger.Pull(); },
              ThrowsMessage<CameraRefusal>(HasSubstr("has neither TimestampLatch nor")));
}

/// Listens at a second address, as a camera would that these actions are for.
class ActionListener {
 public:
  ActionListener() : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_port = htons(3956);
    inet_pton(AF_INET, "127.0.0.2", &name.sin_addr);
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
  }
  ~ActionListener() { close(fd_); }
  /// Time [us] of the next action that waits here.
  std::optional<std::int64_t> Next() const {
    std::array<std::uint8_t, 28> packet;
    if (recv(fd_, packet.data(), packet.size(), 0) != 28) return std::nullopt;
    std::int64_t time_ns = 0;
    for (std::size_t i = 20; i < 28; ++i) time_ns = (time_ns << 8) | packet[i];
    return time_ns / 1000;
  }

 private:
  const int fd_;
};

TEST_F(AravisTriggerTest, ActionsAreAtMultiplesOfThePeriodOfTheCamerasClockEachSentInTime) {
  Open();
  // The latched value stays what we write: a camera whose clock is 1000 s at the start.
  fake_->WriteRegister(kLatchValue, static_cast<std::uint32_t>(1'000'000'000'000 >> 32));
  fake_->WriteRegister(kLatchValue + 4, static_cast<std::uint32_t>(1'000'000'000'000));
  const ActionListener listener;
  const std::int64_t start_us = SystemClock().NowUs();
  AravisTrigger trigger(connection_->camera(), "127.0.0.2", config_);
  std::vector<std::int64_t> times_us;
  while (times_us.size() < 10 && SystemClock().NowUs() < start_us + 2'000'000) {
    const auto wait_us = trigger.Pull();
    EXPECT_LE(wait_us, 20'000u);
    while (const auto time_us = listener.Next()) {
      const std::int64_t camera_now_us = 1'000'000'000 + SystemClock().NowUs() - start_us;
      EXPECT_GT(*time_us, camera_now_us - 5000);           // a busy machine may be late
      EXPECT_LT(*time_us, camera_now_us + 30'000 + 5000);  // lead of half a period, and a period
      times_us.push_back(*time_us);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
  }
  ASSERT_EQ(times_us.size(), 10u);
  for (std::size_t i = 0; i < times_us.size(); ++i) {
    EXPECT_EQ(times_us[i] % 20'000, 0);
    EXPECT_EQ(times_us[i], times_us[0] + static_cast<std::int64_t>(i) * 20'000);
  }
}

}  // namespace
}  // namespace visavis
