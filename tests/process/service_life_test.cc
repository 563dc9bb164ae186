// A live service: from READY to its end, on a real multicast group.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <functional>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "tests/support/child_process.h"
#include "tests/support/network.h"
#include "tests/support/notify_socket.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr auto kDeadline = 10s;

class ServiceLifeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
    bus_.emplace(TestLcmUrl(), "");
    bus_->Subscribe<service_status_t>(kServiceStatusChannel, [this](const service_status_t& m) {
      status_ = m;
      ++num_statuses_;
    });
    bus_->Subscribe<head_pose_t>("ECHO_OUT", [this](const head_pose_t& m) {
      last_out_ = m.seq;
      ++num_outs_;
    });
  }

  // A service on the test's group that has told READY.
  ChildProcess& Start(std::vector<std::string> flags = {}, const std::string& url = TestLcmUrl()) {
    flags.insert(flags.begin(), {VISAVIS_ECHO, "--lcm-url", url});
    service_.emplace(flags, std::vector<std::string>{notify_.variable()});
    EXPECT_THAT(notify_.Receive(kDeadline), HasSubstr("READY=1")) << service_->Err();
    return *service_;
  }

  // Handles messages until @p condition holds. @return whether it did in time.
  bool HandleUntil(const std::function<bool()>& condition) {
    const auto deadline = std::chrono::steady_clock::now() + kDeadline;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      bus_->HandleOne(50);
    }
    return true;
  }

  void Send(std::int64_t seq) {
    head_pose_t message{};
    message.seq = seq;
    bus_->Publish("ECHO_IN", message);
  }

  NotifySocket notify_;
  std::optional<LcmBus> bus_;
  std::optional<ChildProcess> service_;
  service_status_t status_{};
  int num_statuses_{0}, num_outs_{0};
  std::int64_t last_out_{-1};
};

TEST_F(ServiceLifeTest, AnswersFromReadyOnAndStopsOnEachSignalWithExitCode0) {
  for (const int signal : {SIGTERM, SIGINT}) {
    auto& service = Start({"--gain", "5"});
    last_out_ = -1;
    Send(7);
    EXPECT_TRUE(HandleUntil([&] { return last_out_ == 35; }));
    service.Signal(signal);
    EXPECT_EQ(service.Wait(kDeadline), 0);
    EXPECT_THAT(service.Err(), HasSubstr("visavis-echo: stopped"));
    std::string notified;
    while (notified.find("STOPPING=1") == std::string::npos) {
      const std::string next = notify_.Receive(kDeadline);
      ASSERT_NE(next, "") << "after " << notified;
      notified += next;
    }
  }
}

TEST_F(ServiceLifeTest, ItsStatusComesEachSecondWithTheWatchdogs) {
  const auto& service = Start();
  Send(1);
  Send(2);
  ASSERT_TRUE(HandleUntil([&] { return status_.processed == 2; }));
  EXPECT_EQ(status_.service, "echo");
  EXPECT_EQ(status_.pid, service.pid());
  EXPECT_EQ(status_.state, service_status_t::STATE_RUNNING) << status_.state_text;
  EXPECT_GT(status_.memory_mb, 1);
  const int before = num_statuses_;
  const std::int64_t utime = status_.utime;
  ASSERT_TRUE(HandleUntil([&] { return num_statuses_ == before + 2; }));
  EXPECT_GE(status_.utime - utime, 1'900'000);
  EXPECT_THAT(notify_.Receive(kDeadline), HasSubstr("WATCHDOG=1"));
}

TEST_F(ServiceLifeTest, WakesComeAtTheirPeriod) {
  int num_wakes = 0;
  bus_->Subscribe<head_pose_t>("ECHO_WAKE", [&](const head_pose_t&) { ++num_wakes; });
  Start({"--set", "period_ms=5"});
  EXPECT_TRUE(HandleUntil([&] { return num_wakes >= 20; }));
}

TEST_F(ServiceLifeTest, EndsByItselfOnceItHasFinished) {
  auto& service = Start({"--set", "period_ms=5", "--set", "num_wakes=3"});
  EXPECT_EQ(service.Wait(kDeadline), 0);
}

TEST_F(ServiceLifeTest, AnErrorInAHandlerIsToldAndTheServiceGoesOn) {
  Start({"--set", "fail_on_seq=13"});
  Send(13);
  Send(14);
  EXPECT_TRUE(HandleUntil([&] { return last_out_ == 14; }));
  EXPECT_TRUE(HandleUntil([&] { return status_.rejected == 1; }));
  EXPECT_EQ(status_.last_error, "seq: must not be the failing");
}

TEST_F(ServiceLifeTest, AWakeThatFailsForEverIsToldAndTakesNoWholeCore) {
  Start({"--set", "period_ms=1", "--set", "fail_on_seq=5"});
  ASSERT_TRUE(HandleUntil([&] { return status_.rejected >= 5; }));
  EXPECT_LE(status_.rejected, 11 * num_statuses_);  // ten a second
  EXPECT_EQ(status_.last_error, "wake: must not be the failing");
  Send(6);
  EXPECT_TRUE(HandleUntil([&] { return last_out_ == 6; }));
}

TEST_F(ServiceLifeTest, AFileDescriptorAsksForWakesAsLongAsItIsReadable) {
  int num_wakes = 0;
  bus_->Subscribe<head_pose_t>("ECHO_WAKE", [&](const head_pose_t&) { ++num_wakes; });
  Start({"--set", "num_nudges=7"});
  EXPECT_TRUE(HandleUntil([&] { return num_wakes >= 7; }));
  const int before = num_statuses_;
  EXPECT_TRUE(HandleUntil([&] { return num_statuses_ >= before + 2; }));
  EXPECT_EQ(num_wakes, 7);
}

TEST_F(ServiceLifeTest, AWakeForAFileDescriptorThatFailsIsTriedAgainAndTakesNoWholeCore) {
  Start({"--set", "num_nudges=9", "--set", "fail_on_seq=5"});
  ASSERT_TRUE(HandleUntil([&] { return status_.rejected >= 5; }));
  EXPECT_LE(status_.rejected, 11 * num_statuses_);  // ten a second
  Send(6);
  EXPECT_TRUE(HandleUntil([&] { return last_out_ == 6; }));
}

TEST_F(ServiceLifeTest, WhatDoesNotDecodeIsToldAndTheServiceGoesOn) {
  Start();
  bus_->Publish("ECHO_IN", rigid_transform_t{});
  Send(3);
  EXPECT_TRUE(HandleUntil([&] { return last_out_ == 3; }));
  EXPECT_TRUE(HandleUntil([&] { return status_.rejected == 1; }));
  EXPECT_THAT(status_.last_error, HasSubstr("ECHO_IN: is no head_pose_t of"));
}

TEST_F(ServiceLifeTest, AFloodOfMessagesHoldsUpNeitherWakesNorTheStop) {
  int num_wakes = 0;
  bus_->Subscribe<head_pose_t>("ECHO_WAKE", [&](const head_pose_t&) { ++num_wakes; });
  auto& service = Start({"--set", "period_ms=20"});
  EXPECT_TRUE(HandleUntil([&] {
    for (int i = 0; i < 200; ++i) Send(i);
    return num_wakes >= 5;
  }));
  service.Signal(SIGTERM);
  bool ended = false;
  EXPECT_TRUE(HandleUntil([&] {
    for (int i = 0; i < 200; ++i) Send(i);
    ended = ended || service.Wait(0ms).has_value();
    return ended;
  }));
  EXPECT_EQ(service.Wait(0ms), 0);
}

TEST_F(ServiceLifeTest, ThePrefixStandsBeforeAllItsChannels) {
  std::int64_t answer = -1;
  bool told = false;
  bus_->Subscribe<head_pose_t>("ROBOT1_ECHO_OUT", [&](const auto& m) { answer = m.seq; });
  bus_->Subscribe<service_status_t>("ROBOT1_SERVICE_STATUS", [&](const auto&) { told = true; });
  Start({"--prefix", "ROBOT1_"});
  head_pose_t message{};
  message.seq = 9;
  bus_->Publish("ROBOT1_ECHO_IN", message);
  EXPECT_TRUE(HandleUntil([&] { return answer == 9 && told; }));
  EXPECT_EQ(num_outs_ + num_statuses_, 0);
}

// More than any kernel grants: the service says what would mend it.
TEST_F(ServiceLifeTest, AReceiveBufferThatWasCutIsToldWithItsRemedy) {
  Start({}, TestLcmUrl(0, "&recv_buf_size=2000000000"));
  ASSERT_TRUE(HandleUntil([&] { return num_statuses_ > 0; }));
  EXPECT_EQ(status_.state, service_status_t::STATE_DEGRADED);
  EXPECT_THAT(status_.state_text, HasSubstr("2000000000 were asked"));
  EXPECT_THAT(status_.state_text, HasSubstr("'sudo sysctl -w net.core.rmem_max=2000000000'"));
}

// In a network namespace of its own there is no route at all.
TEST(ServiceNetworkTest, WithoutAMulticastRouteItEndsWithTheRemedy) {
  if (RunProcess({"unshare", "-Urn", "true"}).exit_code != 0) {
    GTEST_SKIP() << "unshare -Urn: this machine allows no namespaces of one's own";
  }
  const auto result = RunProcess({"unshare", "-Urn", VISAVIS_ECHO, "--lcm-url", kDefaultLcmUrl});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("visavis-echo: cannot open LCM url"));
  EXPECT_THAT(result.err, HasSubstr("sudo ip route add 224.0.0.0/4 dev lo"));
}

// ... and with the route that the line gives it runs.
TEST(ServiceNetworkTest, TheRemedyMendsIt) {
  if (RunProcess({"unshare", "-Urn", "ip", "link", "show"}).exit_code != 0) {
    GTEST_SKIP() << "unshare -Urn ip: this machine allows no namespaces of one's own, or has no ip";
  }
  const std::string script =
      "ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec \"$@\" --set period_ms=1 "
      "--set num_wakes=3";
  const auto result = RunProcess(
      {"unshare", "-Urn", "sh", "-c", script, "sh", VISAVIS_ECHO, "--lcm-url", kDefaultLcmUrl});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace visavis
