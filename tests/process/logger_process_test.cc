// visavis-logger as users start it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/lcm_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/environment.h"
#include "tests/support/network.h"
#include "tests/support/sequence_folder.h"
#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

std::string Logger() { return Environment("VISAVIS_BIN_DIR") + "/visavis-logger"; }

/// The only log in a folder.
std::string LogIn(const std::string& folder) {
  std::vector<std::string> logs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    logs.push_back(entry.path().string());
  }
  return logs.size() == 1 ? logs[0] : "";
}

TEST(LoggerProcessTest, NothingThatWasSentBeforeSigtermIsLost) {
  const TemporaryFolder folder;
  LcmBus bus(TestLcmUrl(), "");
  ChildProcess logger({Logger(), "--lcm-url", TestLcmUrl(), "--folder", folder / "logs"});
  ASSERT_TRUE(logger.WaitForOutput("running", 10s)) << logger.Err();
  head_pose_t pose{};
  for (pose.seq = 0; pose.seq < 100; ++pose.seq) bus.Publish("HEAD_POSE", pose);
  logger.Signal(SIGTERM);
  EXPECT_EQ(logger.Wait(5s), 0) << logger.Err();
  const std::string log = LogIn(folder / "logs");
  ASSERT_NE(log, "");
  const auto poses = ReadMessages<head_pose_t>(log, "HEAD_POSE");
  ASSERT_EQ(poses.size(), 100u);  // a burst that the smallest socket buffer holds
  for (int i = 0; i < 100; ++i) EXPECT_EQ(poses[static_cast<std::size_t>(i)].seq, i);
  // Stock liblcm reads it too.
  lcm::LogFile file(log, "r");
  EXPECT_NE(file.readNextEvent(), nullptr);
}

TEST(LoggerProcessTest, CountsAppearInItsStatusAndInTheLog) {
  const TemporaryFolder folder;
  LcmBus bus(TestLcmUrl(1), "");
  std::int64_t events = -1;
  bus.Subscribe<service_status_t>("SERVICE_STATUS", [&](const service_status_t& status) {
    for (std::size_t i = 0; i < status.counters.size(); ++i) {
      if (status.counter_names[i] == "events") events = status.counters[i];
    }
  });
  ChildProcess logger({Logger(), "--lcm-url", TestLcmUrl(1), "--folder", folder / "logs"});
  ASSERT_TRUE(logger.WaitForOutput("running", 10s)) << logger.Err();
  head_pose_t pose{};
  for (int i = 0; i < 10; ++i) bus.Publish("HEAD_POSE", pose);
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (events < 10 && std::chrono::steady_clock::now() < deadline) bus.HandleOne(100);
  EXPECT_GE(events, 10);
  // It flushes while it runs, whole events only: kill -9 loses no more than a second.
  const std::string log = LogIn(folder / "logs");
  while (std::filesystem::file_size(log) == 0 && std::chrono::steady_clock::now() < deadline) {
    bus.HandleOne(100);
  }
  logger.Signal(SIGKILL);
  EXPECT_EQ(logger.Wait(5s), -SIGKILL);
  EXPECT_GE(ReadMessages<head_pose_t>(log, "HEAD_POSE").size(), 10u);
}

TEST(LoggerProcessTest, BadUseExitsWith2AndAFolderInTheWayWith1) {
  const TemporaryFolder folder;
  const auto run = [](std::vector<std::string> args) {
    args.insert(args.begin(), {Logger(), "--lcm-url", TestLcmUrl(2)});
    return RunProcess(args);
  };
  EXPECT_EQ(run({"--check-config"}).exit_code, 0);
  EXPECT_EQ(run({"--bogus"}).exit_code, 2);
  const ProcessResult bad = run({"--set", "include=("});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("include: (: must be a regular expression"));
  const ProcessResult failed = run({"--folder", "/proc/none"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("/proc/none: "));
}

}  // namespace
}  // namespace visavis
