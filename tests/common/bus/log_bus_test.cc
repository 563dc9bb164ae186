#include "common/bus/log_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

LogEvent Event(const std::string& channel, std::int64_t seq) {
  head_pose_t message{};
  message.seq = seq;
  LogEvent event;
  event.channel = channel;
  event.data.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
  return event;
}

class LogBusTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  ManualClock clock_;
};

TEST_F(LogBusTest, AnEventReachesThoseOfItsChannelAloneAndInOrder) {
  LogBus bus("", &clock_, nullptr);
  std::vector<std::string> calls;
  bus.Subscribe<head_pose_t>("A",
                             [&](const auto& m) { calls.push_back("A" + std::to_string(m.seq)); });
  bus.Subscribe<head_pose_t>("A", [&](const auto&) { calls.push_back("A again"); });
  bus.Subscribe<head_pose_t>("AB", [&](const auto&) { calls.push_back("AB"); });
  EXPECT_TRUE(bus.Dispatch(Event("A", 7)));
  EXPECT_FALSE(bus.Dispatch(Event("B", 8)));
  EXPECT_THAT(calls, ElementsAre("A7", "A again"));
}

TEST_F(LogBusTest, ThePrefixStandsBeforeChannelsBothWays) {
  EventLogWriter writer(folder_ / "out.lcm", EventLogWriter::Mode::kCreate);
  LogBus bus("ROBOT1_", &clock_, &writer);
  int calls = 0;
  bus.Subscribe<head_pose_t>("A", [&](const auto&) { ++calls; });
  EXPECT_FALSE(bus.Dispatch(Event("A", 0)));
  EXPECT_TRUE(bus.Dispatch(Event("ROBOT1_A", 0)));
  EXPECT_EQ(calls, 1);
  bus.Publish("B", head_pose_t{});
  writer.Close();
  LogEvent event;
  EventLogReader reader(folder_ / "out.lcm");
  ASSERT_TRUE(reader.Next(&event));
  EXPECT_EQ(event.channel, "ROBOT1_B");
}

TEST_F(LogBusTest, SubscribeAllHearsEveryChannel) {
  LogBus bus("ROBOT1_", &clock_, nullptr);
  std::vector<std::string> channels;
  bus.SubscribeAll(
      [&](const std::string& channel, const std::uint8_t*, int size) {
        channels.push_back(channel);
        EXPECT_EQ(size, head_pose_t{}.getEncodedSize());
      },
      5);
  EXPECT_TRUE(bus.Dispatch(Event("A", 0)));
  EXPECT_TRUE(bus.Dispatch(Event("ROBOT1_B", 0)));
  EXPECT_THAT(channels, ElementsAre("A", "ROBOT1_B"));
}

TEST_F(LogBusTest, WhatIsPublishedBearsTheClocksTime) {
  EventLogWriter writer(folder_ / "out.lcm", EventLogWriter::Mode::kCreate);
  LogBus bus("", &clock_, &writer);
  clock_.Set(123456);
  bus.Publish("A", head_pose_t{});
  writer.Close();
  LogEvent event;
  EventLogReader reader(folder_ / "out.lcm");
  ASSERT_TRUE(reader.Next(&event));
  EXPECT_EQ(event.utime, 123456);
}

TEST_F(LogBusTest, WhatDoesNotDecodeIsRejectedByName) {
  LogBus bus("", &clock_, nullptr);
  std::string rejected;
  int calls = 0;
  bus.set_reject_handler(
      [&](const std::string& channel, const std::string& reason) { rejected = channel + reason; });
  bus.Subscribe<head_pose_t>("A", [&](const auto&) { ++calls; });
  for (const int size : {0, 1, 7, 100}) {
    LogEvent event = Event("A", 0);
    event.data.resize(static_cast<std::size_t>(size));
    EXPECT_TRUE(bus.Dispatch(event));
    EXPECT_THAT(rejected, HasSubstr("is no head_pose_t of " + std::to_string(size) + " bytes"));
  }
  EXPECT_EQ(bus.num_rejected(), 4);
  EXPECT_EQ(calls, 0);
}

TEST_F(LogBusTest, WithoutAWriterPublishingIsDropped) {
  LogBus bus("", &clock_, nullptr);
  EXPECT_NO_THROW(bus.Publish("A", head_pose_t{}));
}

TEST_F(LogBusTest, AWriterThatComesLaterGetsWhatIsPublishedFromThenOn) {
  EventLogWriter writer(folder_ / "out.lcm", EventLogWriter::Mode::kCreate);
  LogBus bus("", &clock_, nullptr);
  bus.Publish("A", head_pose_t{});
  bus.SetWriter(&writer);
  bus.Publish("B", head_pose_t{});
  writer.Close();
  EventLogReader reader(folder_ / "out.lcm");
  LogEvent event;
  ASSERT_TRUE(reader.Next(&event));
  EXPECT_EQ(event.channel, "B");
  EXPECT_FALSE(reader.Next(&event));
}

TEST_F(LogBusTest, AFullDiskIsARecordError) {
  EventLogWriter writer("/dev/full", EventLogWriter::Mode::kReplace);
  LogBus bus("", &clock_, &writer);
  EXPECT_THAT(
      [&] {
        for (int i = 0; i < 100000; ++i) bus.Publish("A", head_pose_t{});
      },
      ThrowsMessage<RecordError>(HasSubstr("/dev/full: No space left on device")));
}

}  // namespace
}  // namespace visavis
