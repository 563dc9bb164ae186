#include "services/probe_tool/probe_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <future>
#include <sstream>
#include <string>
#include <vector>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "tests/support/network.h"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

struct Result {
  int exit_code;
  std::string out, err;
};

Result RunProbe(const std::vector<std::string>& args) {
  std::vector<const char*> argv{"visavis-probe"};
  for (const auto& arg : args) argv.push_back(arg.c_str());
  std::ostringstream out, err;
  const int exit_code = RunProbeTool(static_cast<int>(argv.size()), argv.data(), out, err);
  return {exit_code, out.str(), err.str()};
}

TEST(ProbeToolTest, ListenNamesEachServiceThatIsHeardOnce) {
  if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
  auto listening = std::async(std::launch::async, [] {
    return RunProbe({"listen", "--lcm-url", TestLcmUrl(), "--prefix", "R1_", "--seconds", "0.6"});
  });
  LcmBus ours(TestLcmUrl(), "R1_"), theirs(TestLcmUrl(), "R2_");
  service_status_t status{};
  status.version = "0.1.0";
  status.pid = 42;
  status.state = service_status_t::STATE_DEGRADED;
  status.state_text = "disk is full";
  status.rate_hz = 12.5;
  status.latency_p50_ms = std::nan("");
  while (listening.wait_for(50ms) != std::future_status::ready) {
    status.service = "logger";
    status.host = "store";
    ours.Publish(kServiceStatusChannel, status);
    status.service = "recogniser";
    theirs.Publish(kServiceStatusChannel, status);
  }
  const Result result = listening.get();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "logger store 42 0.1.0 DEGRADED 12.5 nan disk is full\n");
}

TEST(ProbeToolTest, TwoParticipantsHearEachOther) {
  if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
  const auto run = [](const std::string& name) {
    return std::async(std::launch::async, [name] {
      return RunProbe({"exchange", name, "--lcm-url", TestLcmUrl(1, "&recv_buf_size=4194304"),
                       "--seconds", "1", "--rate", "10"});
    });
  };
  auto camera = run("camera"), robot = run("robot");
  const Result at_camera = camera.get(), at_robot = robot.get();
  EXPECT_EQ(at_camera.exit_code, 0) << at_camera.err;
  EXPECT_THAT(at_camera.out, HasSubstr("robot small "));
  EXPECT_THAT(at_robot.out, HasSubstr("camera small "));
  EXPECT_THAT(at_robot.out, ::testing::Not(HasSubstr("robot")));
}

TEST(ProbeToolTest, WithoutACommandOrANameItExitsWith2) {
  for (const auto& args : std::vector<std::vector<std::string>>{
           {}, {"bogus"}, {"exchange"}, {"listen", "--seconds", "0"}}) {
    const Result result = RunProbe(args);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(args);
    EXPECT_THAT(result.err, HasSubstr("visavis-probe: "));
  }
}

TEST(ProbeToolTest, ANetworkThatCannotBeOpenedExitsWith1AndSaysWhichUrl) {
  const Result result = RunProbe({"listen", "--lcm-url", "nothing://here"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("nothing://here"));
}

}  // namespace
}  // namespace visavis
