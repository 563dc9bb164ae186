#include "services/logger/logger_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "common/bus/log_bus.h"
#include "tests/support/sequence_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LoggerServiceTest : public ::testing::Test {
 protected:
  LoggerServiceTest() {
    config_.folder = folder_ / "logs";
    clock_.Set(1'732'295'101'000'000);
  }

  void Send(const std::string& channel, const std::vector<std::uint8_t>& data) {
    bus_.Dispatch({0, 0, channel, data});
  }
  template <typename Message>
  void SendMessage(const std::string& channel, const Message& message) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    Send(channel, bytes);
  }
  static image_t Image(std::int32_t pixelformat) {
    image_t image{};
    image.pixelformat = pixelformat;
    return image;
  }
  static images_t Pair(std::int32_t left, std::int32_t right) {
    images_t pair{};
    pair.n_images = 2;
    pair.image_types = {images_t::LEFT, images_t::RIGHT};
    pair.images = {Image(left), Image(right)};
    return pair;
  }
  static std::vector<std::string> Channels(const std::string& log) {
    std::vector<std::string> channels;
    for (const auto& event : ReadEvents(log)) channels.push_back(event.channel);
    return channels;
  }
  /// Sends a pair of each kind and a pose, and returns what a logger with @p images kept.
  std::vector<std::string> Kept(const std::string& images) {
    config_.images = images;
    LoggerService logger(config_, context_);
    const std::int32_t kJpeg = image_t::PIXELFORMAT_MJPEG, kRgb = image_t::PIXELFORMAT_RGB;
    SendMessage("JPEG_PAIR", Pair(kJpeg, kJpeg));
    SendMessage("MIXED_PAIR", Pair(kJpeg, kRgb));
    SendMessage("RAW_IMAGE", Image(kRgb));
    SendMessage("JPEG_IMAGE", Image(kJpeg));
    Send("OTHER", {1, 2, 3});
    logger.Finish();
    return Channels(logger.log());
  }

  const TemporaryFolder folder_;
  LoggerConfig config_;
  ManualClock clock_;
  LogBus bus_{"", &clock_, nullptr};
  StatusReporter status_{"logger", "0"};
  const ServiceContext context_{&bus_, &clock_, &status_, false};
};

TEST_F(LoggerServiceTest, WritesEveryMessageAsItCameAtItsTime) {
  LoggerService logger(config_, context_);
  EXPECT_EQ(logger.log(), folder_ / "logs/visavis-20241122T170501Z.lcm");
  Send("A", {1, 2, 3});
  clock_.Set(clock_.NowUs() + 5);
  Send("B", {});
  logger.Finish();
  const auto events = ReadEvents(logger.log());
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].channel, "A");
  EXPECT_THAT(events[0].data, ElementsAre(1, 2, 3));
  EXPECT_EQ(events[0].utime, 1'732'295'101'000'000);
  EXPECT_EQ(events[1].utime, 1'732'295'101'000'005);
  EXPECT_EQ(events[1].number, 1);
}

TEST_F(LoggerServiceTest, IncludeAndExcludeChooseChannels) {
  config_.include = "HEAD_.*";
  config_.exclude = "HEAD_POSE_TRUTH";
  LoggerService logger(config_, context_);
  for (const char* channel : {"HEAD_POSE", "HEAD_POSE_TRUTH", "ARM_STATE"}) Send(channel, {1});
  logger.UpdateStatus();
  logger.Finish();
  EXPECT_THAT(Channels(logger.log()), ElementsAre("HEAD_POSE"));
  const service_status_t& status = status_.Make(clock_.NowUs());
  EXPECT_THAT(status.counter_names, ElementsAre("bytes", "events", "left_out"));
  EXPECT_THAT(status.counters, ElementsAre(28 + 9 + 1, 1, 2));
  EXPECT_EQ(status.processed, 1);
}

TEST_F(LoggerServiceTest, ImagesAllKeepsEveryImage) {
  EXPECT_THAT(Kept("all"),
              ElementsAre("JPEG_PAIR", "MIXED_PAIR", "RAW_IMAGE", "JPEG_IMAGE", "OTHER"));
}

TEST_F(LoggerServiceTest, ImagesJpegKeepsMessagesOfJpegsOnly) {
  EXPECT_THAT(Kept("jpeg"), ElementsAre("JPEG_PAIR", "JPEG_IMAGE", "OTHER"));
}

TEST_F(LoggerServiceTest, ImagesNoneKeepsNone) { EXPECT_THAT(Kept("none"), ElementsAre("OTHER")); }

TEST_F(LoggerServiceTest, NoLogIsEverOverwritten) {
  LoggerService first(config_, context_);
  LoggerService second(config_, context_);
  LoggerService third(config_, context_);
  EXPECT_EQ(second.log(), folder_ / "logs/visavis-20241122T170501Z-1.lcm");
  EXPECT_EQ(third.log(), folder_ / "logs/visavis-20241122T170501Z-2.lcm");
}

TEST_F(LoggerServiceTest, FlushesOncePerPeriod) {
  LoggerService logger(config_, context_);
  EXPECT_EQ(logger.next_wake_us(), clock_.NowUs() + 1'000'000);
  Send("A", {1});
  EXPECT_EQ(ReadEvents(logger.log()).size(), 0u);
  clock_.Set(logger.next_wake_us());
  logger.Wake();
  EXPECT_EQ(ReadEvents(logger.log()).size(), 1u);
  EXPECT_EQ(logger.next_wake_us(), clock_.NowUs() + 1'000'000);
}

TEST_F(LoggerServiceTest, AFullDiskIsToldAndTheLoggerGoesOn) {
  LoggerService logger(config_, context_);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{100, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  Send("A", std::vector<std::uint8_t>(200));
  logger.Wake();
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_THAT(status_.Make(1).state_text, HasSubstr(logger.log() + ": File too large"));
  EXPECT_EQ(status_.Make(1).dropped, 1);
  EXPECT_EQ(status_.Make(1).state, service_status_t::STATE_DEGRADED);
  Send("B", {1});
  logger.Wake();
  EXPECT_EQ(status_.Make(1).state_text, "");
  EXPECT_THAT(Channels(logger.log()), ElementsAre("B"));
}

TEST_F(LoggerServiceTest, ADiskThatRunsFullIsToldBefore) {
  config_.min_free_mb = 1'000'000'000;
  LoggerService logger(config_, context_);
  logger.UpdateStatus();
  EXPECT_THAT(status_.Make(1).state_text, HasSubstr("MB left on the disk"));
}

TEST_F(LoggerServiceTest, AFolderThatCannotBeMadeIsRefused) {
  config_.folder = "/proc/none";
  EXPECT_THAT([&] { LoggerService logger(config_, context_); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("/proc/none: ")));
}

}  // namespace
}  // namespace visavis
