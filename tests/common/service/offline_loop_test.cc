#include "common/service/offline_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <optional>

#include "tests/support/echo_service.h"
#include "tests/support/log_writing.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

constexpr std::int64_t kMs = 1000;

// "IN 12" for an event at 12 ms after kStart; the message's seq behind it where it is one.
constexpr std::int64_t kStart = 1'700'000'000'000'000;

class OfflineLoopTest : public ::testing::Test {
 protected:
  struct Input {
    std::string channel;
    std::int64_t ms;
    std::int64_t seq;
  };

  void WriteLog(const std::vector<Input>& inputs) {
    EventLogWriter writer(folder_ / "in.lcm", EventLogWriter::Mode::kReplace);
    for (const auto& input : inputs) {
      head_pose_t message{};
      message.utime = kStart + input.ms * kMs;
      message.seq = input.seq;
      WriteMessage(input.channel, message, &writer);
    }
    writer.Close();
  }

  // Replays in.lcm to an EchoService; what the new log holds, event by event, without statuses.
  std::vector<std::string> ReplayLog(const EchoConfig& config, bool keep_images = false,
                                     bool with_filter = true) {
    {
      EventLogReader reader(folder_ / "in.lcm");
      EventLogWriter writer(folder_ / "out.lcm", EventLogWriter::Mode::kReplace);
      LogBus bus("", &clock_, &writer);
      EchoService service(config, {&bus, &clock_, &status_, false});
      Replay::Filter filter;
      if (with_filter) filter = EchoService::ReplayFilter(config, "");
      filter.keep_images = keep_images;
      Replay(&service, &bus, &clock_, &status_, &writer).Run(&reader, filter, stop_);
    }
    return ReadLog(folder_ / "out.lcm");
  }

  static std::vector<std::string> ReadLog(const std::string& path) {
    std::vector<std::string> events;
    EventLogReader reader(path);
    LogEvent event;
    head_pose_t message;
    while (reader.Next(&event)) {
      if (event.channel == "SERVICE_STATUS") continue;
      const int size = static_cast<int>(event.data.size());
      EXPECT_EQ(message.decode(event.data.data(), 0, size), size);
      events.push_back(event.channel + " " + std::to_string((event.utime - kStart) / kMs) + " #" +
                       std::to_string(message.seq));
    }
    return events;
  }

  TemporaryFolder folder_;
  StopSignal stop_;
  ManualClock clock_;
  StatusReporter status_{"echo", "0"};
};

TEST_F(OfflineLoopTest, InputsAndAnswersStandInTheNewLogInOrder) {
  WriteLog({{"ECHO_IN", 0, 1}, {"OTHER", 5, 2}, {"ECHO_IN", 10, 3}});
  EchoConfig config;
  config.gain = 10;
  EXPECT_THAT(ReplayLog(config),
              ElementsAre("ECHO_IN 0 #1", "ECHO_OUT 0 #10", "OTHER 5 #2", "ECHO_IN 10 #3",
                          "ECHO_OUT 10 #30", "ECHO_FINISHED 10 #0"));
  EXPECT_EQ(status_.processed(), 2);
}

TEST_F(OfflineLoopTest, WakesComeAtTheirTimeBeforeLaterEvents) {
  WriteLog({{"ECHO_IN", 0, 1}, {"ECHO_IN", 25, 2}, {"ECHO_IN", 30, 3}});
  EchoConfig config;
  config.period_ms = 10;
  EXPECT_THAT(ReplayLog(config),
              ElementsAre("ECHO_WAKE 0 #0", "ECHO_IN 0 #1", "ECHO_OUT 0 #1",     //
                          "ECHO_WAKE 10 #1", "ECHO_WAKE 20 #2",                  //
                          "ECHO_IN 25 #2", "ECHO_OUT 25 #2",                     //
                          "ECHO_WAKE 30 #3", "ECHO_IN 30 #3", "ECHO_OUT 30 #3",  //
                          "ECHO_FINISHED 30 #0"));
}

TEST_F(OfflineLoopTest, OutputOfAnEarlierRunIsLeftOutAndTheSameRunComesAgain) {
  WriteLog({{"ECHO_IN", 0, 1}, {"OTHER", 12, 5}, {"ECHO_IN", 31, 2}});
  EchoConfig config;
  config.period_ms = 10;
  const auto once = ReplayLog(config);
  std::filesystem::rename(folder_ / "out.lcm", folder_ / "in.lcm");
  EXPECT_EQ(ReplayLog(config), once);
}

TEST_F(OfflineLoopTest, ImagesAreRecordedOnlyWhereTheyAreKept) {
  WriteLog({{"IMAGES", 0, 1}, {"ECHO_IN", 1, 2}});
  EXPECT_THAT(ReplayLog({}), ElementsAre("ECHO_IN 1 #2", "ECHO_OUT 1 #2", "ECHO_FINISHED 1 #0"));
  EXPECT_THAT(ReplayLog({}, true),
              ElementsAre("IMAGES 0 #1", "ECHO_IN 1 #2", "ECHO_OUT 1 #2", "ECHO_FINISHED 1 #0"));
}

TEST_F(OfflineLoopTest, WithoutAFilterEveryEventIsAnInput) {
  WriteLog({{"IMAGES", 0, 1}, {"ECHO_OUT", 1, 2}});
  EXPECT_THAT(ReplayLog({}, false, false),
              ElementsAre("IMAGES 0 #1", "ECHO_OUT 1 #2", "ECHO_FINISHED 1 #0"));
}

TEST_F(OfflineLoopTest, AJumpBackByMoreThanASecondIsANewSession) {
  WriteLog({{"ECHO_IN", 5000, 1}, {"ECHO_IN", 3999, 2}, {"ECHO_IN", 4050, 3}});
  EchoConfig config;
  EXPECT_THAT(ReplayLog(config),
              ElementsAre("ECHO_IN 5000 #1", "ECHO_OUT 5000 #1", "ECHO_FINISHED 5000 #0",  //
                          "ECHO_IN 3999 #2", "ECHO_OUT 3999 #2",                           //
                          "ECHO_IN 4050 #3", "ECHO_OUT 4050 #3", "ECHO_FINISHED 4050 #1"));
}

TEST_F(OfflineLoopTest, ASmallerJumpBackStaysInTheSessionAndTheClockStandsStill) {
  WriteLog({{"ECHO_IN", 5000, 1}, {"ECHO_IN", 4000, 2}, {"ECHO_IN", 5100, 3}});
  EXPECT_THAT(ReplayLog({}), ElementsAre("ECHO_IN 5000 #1", "ECHO_OUT 5000 #1", "ECHO_IN 4000 #2",
                                         "ECHO_OUT 5000 #2", "ECHO_IN 5100 #3", "ECHO_OUT 5100 #3",
                                         "ECHO_FINISHED 5100 #0"));
}

TEST_F(OfflineLoopTest, AnErrorInAHandlerOrWakeIsCountedAndTheReplayGoesOn) {
  WriteLog({{"ECHO_IN", 0, 3}, {"ECHO_IN", 1, 4}});
  EchoConfig config;
  config.fail_on_seq = 3;
  EXPECT_THAT(ReplayLog(config),
              ElementsAre("ECHO_IN 0 #3", "ECHO_IN 1 #4", "ECHO_OUT 1 #4", "ECHO_FINISHED 1 #0"));
  EXPECT_EQ(status_.rejected(), 1);
  EXPECT_EQ(status_.last_error(), "seq: must not be the failing");

  config.fail_on_seq = 0;
  config.period_ms = 10;
  ReplayLog(config);  // a wake that fails is tried again at each event, and hangs nothing
  EXPECT_EQ(status_.last_error(), "wake: must not be the failing");
  EXPECT_EQ(status_.rejected(), 3);
}

TEST_F(OfflineLoopTest, AStatusComesOnceASecondOfLogTime) {
  std::vector<Input> inputs;
  for (int i = 0; i <= 35; ++i) inputs.push_back({"ECHO_IN", 100 * i, i});
  WriteLog(inputs);
  ReplayLog({});
  EventLogReader reader(folder_ / "out.lcm");
  LogEvent event;
  service_status_t status;
  std::vector<std::int64_t> times, processed;
  while (reader.Next(&event)) {
    if (event.channel != "SERVICE_STATUS") continue;
    EXPECT_GT(status.decode(event.data.data(), 0, static_cast<int>(event.data.size())), 0);
    times.push_back((event.utime - kStart) / kMs);
    processed.push_back(status.processed);
  }
  EXPECT_THAT(times, ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(processed, ElementsAre(10, 20, 30));
}

TEST_F(OfflineLoopTest, AStopSignalEndsTheReplay) {
  WriteLog({{"ECHO_IN", 0, 1}});
  raise(SIGTERM);
  EXPECT_THAT(ReplayLog({}), ElementsAre(HasSubstr("ECHO_FINISHED")));
  sigset_t term;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  int taken = 0;
  sigwait(&term, &taken);
}

TEST_F(OfflineLoopTest, AnEmptyLogGivesTheFinishAlone) {
  WriteLog({});
  EXPECT_EQ(ReplayLog({}).size(), 1u);
}

TEST_F(OfflineLoopTest, AFullDiskEndsTheReplay) {
  std::vector<Input> inputs(20000, {"ECHO_IN", 0, 1});
  WriteLog(inputs);
  EventLogReader reader(folder_ / "in.lcm");
  EventLogWriter writer("/dev/full", EventLogWriter::Mode::kReplace);
  LogBus bus("", &clock_, &writer);
  EchoService service({}, {&bus, &clock_, &status_, false});
  EXPECT_THAT(
      [&] {
        // The inputs are not recorded, so that it is a handler's own publishing that fails.
        Replay(&service, &bus, &clock_, &status_, nullptr).Run(&reader, {}, stop_);
      },
      ThrowsMessage<RecordError>(HasSubstr("No space left on device")));
}

class FastRunTest : public OfflineLoopTest {
 protected:
  std::vector<std::string> Run(const EchoConfig& config) {
    {
      EventLogWriter writer(folder_ / "out.lcm", EventLogWriter::Mode::kReplace);
      LogBus bus("", &clock_, &writer);
      clock_.Set(kStart);
      EchoService service(config, {&bus, &clock_, &status_, false});
      RunFast(&service, &clock_, &status_, stop_);
    }
    return ReadLog(folder_ / "out.lcm");
  }
};

TEST_F(FastRunTest, TheClockJumpsFromWakeToWakeUntilItHasFinished) {
  EchoConfig config;
  config.period_ms = 5000;
  config.num_wakes = 3;
  EXPECT_THAT(Run(config), ElementsAre("ECHO_WAKE 0 #0", "ECHO_WAKE 5000 #1", "ECHO_WAKE 10000 #2",
                                       "ECHO_FINISHED 10000 #0"));
}

TEST_F(FastRunTest, AServiceWithoutWakesIsDoneAtOnce) {
  EXPECT_THAT(Run({}), ElementsAre("ECHO_FINISHED 0 #0"));
}

TEST_F(FastRunTest, AWakeThatFailsForEverEndsTheRun) {
  EchoConfig config;
  config.period_ms = 5;
  config.fail_on_seq = 2;
  EXPECT_THAT([&] { Run(config); },
              ThrowsMessage<std::runtime_error>("wake: must not be the failing"));
}

}  // namespace
}  // namespace visavis
