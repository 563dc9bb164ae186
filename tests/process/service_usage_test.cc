// Flags, configuration, replay and fast runs of a service as its users start it: what it prints and
// its exit code. Nothing here needs a network.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/eventlog/event_log.h"
#include "tests/support/child_process.h"
#include "tests/support/log_writing.h"
#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class ServiceUsageTest : public ::testing::Test {
 protected:
  static ProcessResult Run(std::vector<std::string> flags) {
    flags.insert(flags.begin(), VISAVIS_ECHO);
    return RunProcess(flags);
  }
  // A flag or configuration that must be refused: the one line it prints.
  static std::string Refusal(const std::vector<std::string>& flags, int exit_code = 2) {
    const ProcessResult result = Run(flags);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, StartsWith("visavis-echo: "));
    return result.err;
  }
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  std::string WriteLog() {
    EventLogWriter writer(folder_ / "in.lcm", EventLogWriter::Mode::kReplace);
    for (int i = 0; i < 5; ++i) {
      head_pose_t message{};
      message.utime = 1'000'000 + 1000 * i;
      message.seq = i;
      WriteMessage("ECHO_IN", message, &writer);
    }
    writer.Close();
    return folder_ / "in.lcm";
  }
  static std::int64_t CountEvents(const std::string& path) {
    EventLogReader reader(path);
    LogEvent event;
    while (reader.Next(&event)) continue;
    return reader.num_events();
  }
  TemporaryFolder folder_;
};

TEST_F(ServiceUsageTest, HelpAndVersionGoToStdoutWithExitCode0) {
  const ProcessResult help = Run({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string flag : {"--config", "--set", "--check-config", "--lcm-url", "--prefix",
                                 "--replay", "--record", "--keep-images", "--fast", "--version"}) {
    EXPECT_THAT(help.out, HasSubstr(flag));
  }
  EXPECT_THAT(help.out, HasSubstr("short for --set gain="));
  const ProcessResult version = Run({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("visavis-echo 0."));
}

TEST_F(ServiceUsageTest, ABadFlagGetsOneLineAndExitCode2) {
  EXPECT_THAT(Refusal({"--bogus"}), HasSubstr("--bogus"));
  EXPECT_THAT(Refusal({"stray"}), HasSubstr("stray"));
  EXPECT_THAT(Refusal({"--keep-images"}), HasSubstr("--record"));
  EXPECT_THAT(Refusal({"--fast"}), HasSubstr("--record"));
  EXPECT_THAT(Refusal({"--set", "gain"}), HasSubstr("--set gain: must read KEY=VALUE"));
}

TEST_F(ServiceUsageTest, APrefixThatIsNoPartOfAChannelsNameIsRefusedWithItsOrigin) {
  EXPECT_THAT(Refusal({"--prefix", "robot 1"}),
              HasSubstr("--prefix robot 1: must be at most 31 characters of A-Z, 0-9 and _"));
  EXPECT_THAT(Refusal({"--prefix", std::string(32, 'A')}), HasSubstr("at most 31"));
  const ProcessResult result =
      RunProcess({VISAVIS_ECHO, "--print-config"}, {"VISAVIS_PREFIX=ROBOT.*"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("visavis-echo: VISAVIS_PREFIX=ROBOT.*: must be at most 31"));
}

TEST_F(ServiceUsageTest, APrefixOfTheEnvironmentGoesBeforeEveryChannelUnlessAFlagSaysElse) {
  const auto count = [&](const std::string& variable, const std::vector<std::string>& flags) {
    const std::string out = folder_ / "prefixed.lcm";
    std::vector<std::string> args{VISAVIS_ECHO, "--replay", WriteLog(), "--record", out};
    args.insert(args.end(), flags.begin(), flags.end());
    EXPECT_EQ(RunProcess(args, {variable}).exit_code, 0);
    return CountEvents(out);
  };
  // WriteLog's five events carry no prefix: heard without one alone.
  EXPECT_EQ(count("VISAVIS_PREFIX=", {}), 5 + 5 + 1);
  EXPECT_EQ(count("VISAVIS_PREFIX=ROBOT1_", {"--prefix", ""}), 5 + 5 + 1);
  EXPECT_LT(count("VISAVIS_PREFIX=ROBOT1_", {}), 5 + 5);
}

TEST_F(ServiceUsageTest, ABadConfigurationGetsOneLineWithPlaceKeyValueAndRule) {
  const std::string bad = Write("bad.yaml", "input: IN\ngain: 0\n");
  EXPECT_THAT(Refusal({"--config", bad}), HasSubstr("bad.yaml:2: gain: 0: must be 1 to 100"));
  const std::string unknown = Write("unknown.yaml", "# a note\n\ngian: 2\n");
  EXPECT_THAT(Refusal({"--config", unknown}),
              HasSubstr("unknown.yaml:3: gian: 2: unknown key, must be one of"));
  const std::string equal = Write("equal.yaml", "input: A\noutput: A\n");
  EXPECT_THAT(Refusal({"--config", equal}),
              HasSubstr("equal.yaml:2: output: A: must differ from input"));
  EXPECT_THAT(Refusal({"--config", folder_ / "none.yaml"}), HasSubstr("none.yaml: cannot be read"));
  EXPECT_THAT(Refusal({"--gain", "many"}),
              HasSubstr("--set gain=many: gain: many: must be a whole number"));
  EXPECT_THAT(Refusal({"--set", "input=a b"}), HasSubstr("must be 1 to 63 characters of A-Z"));
}

TEST_F(ServiceUsageTest, CheckConfigSaysNothingOfAGoodOne) {
  const std::string good = Write("good.yaml", "gain: 3\n");
  const ProcessResult result = Run({"--config", good, "--check-config"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out + result.err, "");
}

TEST_F(ServiceUsageTest, PrintConfigReadsBackAsTheSame) {
  const ProcessResult first = Run({"--gain=7", "--set", "input=ABC", "--print-config"});
  EXPECT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.out, AllOf(HasSubstr("gain: 7"), HasSubstr("input: ABC")));
  const std::string copy = Write("copy.yaml", first.out);
  EXPECT_EQ(Run({"--config", copy, "--print-config"}).out, first.out);
}

TEST_F(ServiceUsageTest, AReplayEndsWith0AndItsLogHoldsInputsAndAnswers) {
  const ProcessResult result = Run({"--replay", WriteLog(), "--record", folder_ / "out.lcm"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(CountEvents(folder_ / "out.lcm"), 5 + 5 + 1);
}

TEST_F(ServiceUsageTest, AReplayWithRefusedMessagesSaysSo) {
  const ProcessResult result = Run({"--replay", WriteLog(), "--set", "fail_on_seq=2"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("refused 1 messages, the last: seq: must not be the failing"));
}

TEST_F(ServiceUsageTest, AReplayOfADamagedLogSaysWhatItLeftOut) {
  const std::string in = WriteLog();
  std::ofstream(in, std::ios::app) << "no event at all";
  const ProcessResult result = Run({"--replay", in});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("left out 15 damaged bytes"));
}

TEST_F(ServiceUsageTest, ALogThatCannotBeReadOrWrittenIsNamed) {
  EXPECT_THAT(Refusal({"--replay", folder_ / "none.lcm"}, 1),
              HasSubstr("none.lcm: No such file or directory"));
  EXPECT_THAT(Refusal({"--replay", WriteLog(), "--record", "/nonexistent/out.lcm"}, 1),
              HasSubstr("/nonexistent/out.lcm: No such file or directory"));
  EXPECT_THAT(Refusal({"--replay", WriteLog(), "--record", "/dev/full"}, 1),
              HasSubstr("/dev/full: No space left on device"));
}

TEST_F(ServiceUsageTest, ALogIsNotReplayedOntoItself) {
  const std::string in = WriteLog();
  EXPECT_THAT(Refusal({"--replay", in, "--record", folder_.path().string() + "/./in.lcm"}),
              HasSubstr("must be another file than --replay"));
  EXPECT_EQ(CountEvents(in), 5);
}

TEST_F(ServiceUsageTest, AFastRunWritesItsLogAndEnds) {
  const ProcessResult result = Run({"--fast", "--record", folder_ / "out.lcm", "--set",
                                    "period_ms=60000", "--set", "num_wakes=4"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(CountEvents(folder_ / "out.lcm"), 4 + 1);
}

TEST_F(ServiceUsageTest, ABusThatCannotBeOpenedIsARunTimeFailure) {
  const ProcessResult result = Run({"--lcm-url", "nonsense://"});  // LCM prints a line of its own
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("visavis-echo: cannot open LCM url 'nonsense://'"));
}

}  // namespace
}  // namespace visavis
