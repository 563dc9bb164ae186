#include "common/service/status_reporter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <limits>

#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;

constexpr std::int64_t kSecond = 1'000'000;
const double kNan = std::nan("");

class StatusReporterTest : public ::testing::Test {
 protected:
  StatusReporter status_{"echo", "1.2.3"};
};

TEST_F(StatusReporterTest, TellsWhoItIs) {
  const service_status_t& m = status_.Make(5 * kSecond);
  EXPECT_EQ(m.service, "echo");
  EXPECT_EQ(m.version, "1.2.3");
  EXPECT_EQ(m.pid, getpid());
  EXPECT_EQ(m.utime, 5 * kSecond);
  EXPECT_FALSE(m.host.empty());
  EXPECT_EQ(m.state, service_status_t::STATE_RUNNING);
  EXPECT_EQ(m.state_text, "");
}

TEST_F(StatusReporterTest, UptimeCountsFromTheFirstStatus) {
  EXPECT_EQ(status_.Make(5 * kSecond).uptime_s, 0);
  EXPECT_NEAR(status_.Make(65 * kSecond).uptime_s, 60, 1e-9);
}

TEST_F(StatusReporterTest, TheRateIsThatOfTheTimeSinceTheLastStatus) {
  EXPECT_EQ(status_.Make(0).rate_hz, 0);
  for (int i = 0; i < 30; ++i) status_.Processed(kNan);
  EXPECT_NEAR(status_.Make(2 * kSecond).rate_hz, 15, 1e-9);
  EXPECT_EQ(status_.Make(3 * kSecond).rate_hz, 0);
  EXPECT_EQ(status_.Make(4 * kSecond).processed, 30);
}

TEST_F(StatusReporterTest, AClockSetBackGivesNoNegativeFigures) {
  status_.Make(10 * kSecond);
  status_.Processed(1);
  const service_status_t& m = status_.Make(3 * kSecond);
  EXPECT_GE(m.rate_hz, 0);
  EXPECT_GE(m.cpu_percent, 0);
  EXPECT_GE(m.uptime_s, 0);
  status_.Processed(1);
  EXPECT_NEAR(status_.Make(4 * kSecond).rate_hz, 1, 1e-9);
}

TEST_F(StatusReporterTest, LatenciesAreQuantilesOfTheLastSecondAlone) {
  for (int i = 100; i >= 0; --i) status_.Processed(i);
  service_status_t m = status_.Make(kSecond);
  EXPECT_EQ(m.latency_p50_ms, 50);
  EXPECT_EQ(m.latency_p99_ms, 99);
  EXPECT_EQ(m.latency_max_ms, 100);
  status_.Processed(7);
  status_.Processed(kNan);
  m = status_.Make(2 * kSecond);
  EXPECT_EQ(m.latency_p50_ms, 7);
  EXPECT_EQ(m.latency_max_ms, 7);
  EXPECT_EQ(m.processed, 103);
  EXPECT_TRUE(std::isnan(status_.Make(3 * kSecond).latency_p50_ms));
}

TEST_F(StatusReporterTest, DroppedAndRejectedAreCountedAndTheLastErrorTold) {
  status_.Dropped(3);
  status_.Rejected("a: 1: must be 2", 7);
  status_.Rejected("b: 2: must be 3", 8);
  status_.Error("disk is full", 9);
  const service_status_t& m = status_.Make(kSecond);
  EXPECT_EQ(m.dropped, 3);
  EXPECT_EQ(m.rejected, 2);
  EXPECT_EQ(m.last_error, "disk is full");
  EXPECT_EQ(m.last_error_utime, 9);
  EXPECT_EQ(m.state, service_status_t::STATE_RUNNING);
}

TEST_F(StatusReporterTest, ItIsDegradedWhileAnyConditionHolds) {
  status_.SetCondition("rig", "no rig yet");
  status_.SetCondition("buffer", "buffer too small");
  service_status_t m = status_.Make(kSecond);
  EXPECT_EQ(m.state, service_status_t::STATE_DEGRADED);
  EXPECT_EQ(m.state_text, "buffer too small; no rig yet");
  status_.SetCondition("rig", "");
  m = status_.Make(2 * kSecond);
  EXPECT_EQ(m.state_text, "buffer too small");
  status_.SetCondition("buffer", "");
  m = status_.Make(3 * kSecond);
  EXPECT_EQ(m.state, service_status_t::STATE_RUNNING);
  EXPECT_EQ(m.state_text, "");
}

TEST_F(StatusReporterTest, CountersAreNamedAndKeptUntilSetAnew) {
  status_.SetCounter("b", 2);
  status_.SetCounter("a", 1);
  status_.Make(kSecond);
  status_.SetCounter("a", 5);
  const service_status_t& m = status_.Make(2 * kSecond);
  EXPECT_EQ(m.num_counters, 2);
  EXPECT_THAT(m.counter_names, ElementsAre("a", "b"));
  EXPECT_THAT(m.counters, ElementsAre(5, 2));
}

TEST_F(StatusReporterTest, CpuAndMemoryAreThoseOfThisProcess) {
  status_.Make(0);
  volatile double x = 1;
  for (int i = 0; i < 20'000'000; ++i) x = x + 1e-9 * x;
  const service_status_t& m = status_.Make(kSecond);
  EXPECT_GT(m.cpu_percent, 0.5);
  EXPECT_LT(m.cpu_percent, 2000);
  EXPECT_GT(m.memory_mb, 1);
  EXPECT_LT(m.memory_mb, 4000);
}

TEST_F(StatusReporterTest, TheClockIsUnknownWhereTheKernelDoesNotTell) {
  ClockSync clock;
  EXPECT_EQ(ClockStateOf(clock), service_status_t::CLOCK_UNKNOWN);
  clock.known = true;
  EXPECT_EQ(ClockStateOf(clock), service_status_t::CLOCK_UNSYNCHRONISED);
  clock.synchronised = true;
  EXPECT_EQ(ClockStateOf(clock), service_status_t::CLOCK_SYNCHRONISED);
}

TEST_F(StatusReporterTest, TheStatusEncodes) {
  status_.SetCounter("a", 1);
  const service_status_t& m = status_.Make(kSecond);
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(m.getEncodedSize()));
  EXPECT_EQ(m.encode(bytes.data(), 0, m.getEncodedSize()), m.getEncodedSize());
}

TEST_F(StatusReporterTest, RecordingAnInputAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  const std::int64_t before = NumMallocs();
  for (int i = 0; i < 10000; ++i) status_.Processed(i);
  EXPECT_EQ(NumMallocs() - before, 0);
  EXPECT_EQ(status_.processed(), 10000);
}

}  // namespace
}  // namespace visavis
