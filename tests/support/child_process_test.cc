#include "tests/support/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ChildProcessTest, KeepsBothOutputsAndTheExitCode) {
  const auto result = RunProcess({"sh", "-c", "echo out; echo err >&2; exit 3"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.out, "out\n");
  EXPECT_EQ(result.err, "err\n");
}

TEST(ChildProcessTest, KeepsMoreOutputThanAPipeHolds) {
  EXPECT_EQ(RunProcess({"sh", "-c", "head -c 1000000 /dev/zero"}).out.size(), 1'000'000u);
}

TEST(ChildProcessTest, GivesArgumentsAndEnvironmentAsTheyAre) {
  const auto result = RunProcess({"sh", "-c", "echo \"$1,$A_B,${HOME:+home}\"", "sh", "a  b"},
                                 {"A_B=c d", "HOME="});
  EXPECT_EQ(result.out, "a  b,c d,\n");
}

TEST(ChildProcessTest, StdinIsEmpty) { EXPECT_EQ(RunProcess({"cat"}).out, ""); }

TEST(ChildProcessTest, ASignalShowsAsItsNegativeNumber) {
  ChildProcess process({"sleep", "100"});
  EXPECT_EQ(process.Wait(1ms), std::nullopt);
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(5s), -SIGTERM);
  EXPECT_EQ(process.Wait(0ms), -SIGTERM);
}

TEST(ChildProcessTest, BlockedSignalsOfTheTestAreNotInherited) {
  sigset_t term, before;
  sigemptyset(&term);
  sigaddset(&term, SIGTERM);
  sigprocmask(SIG_BLOCK, &term, &before);
  ChildProcess process({"sleep", "100"});
  sigprocmask(SIG_SETMASK, &before, nullptr);
  process.Signal(SIGTERM);
  EXPECT_EQ(process.Wait(5s), -SIGTERM);
}

TEST(ChildProcessTest, WaitsForOutputUntilTheTextOrTheEnd) {
  ChildProcess talker({"sh", "-c", "echo first; sleep 0.05; echo second >&2; sleep 100"});
  EXPECT_TRUE(talker.WaitForOutput("second", 5s));
  EXPECT_FALSE(talker.WaitForOutput("third", 10ms));
  ChildProcess ended({"true"});
  EXPECT_FALSE(ended.WaitForOutput("anything", 100s));
}

TEST(ChildProcessTest, AProcessThatIsLeftBehindIsKilled) {
  pid_t pid = 0;
  {
    const ChildProcess process({"sleep", "100"});
    pid = process.pid();
    EXPECT_EQ(kill(pid, 0), 0);
  }
  EXPECT_EQ(kill(pid, 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST(ChildProcessTest, AMissingProgramEndsWith127) {
  EXPECT_EQ(RunProcess({"/nonexistent/program"}).exit_code, 127);
}

TEST(ChildProcessTest, RunProcessGivesUpAtItsDeadline) {
  EXPECT_THAT(
      [] {
        RunProcess({"sleep", "100"}, {}, 10ms);
      },
      ThrowsMessage<std::runtime_error>(HasSubstr("sleep still runs after 10 ms")));
}

}  // namespace
}  // namespace visavis
