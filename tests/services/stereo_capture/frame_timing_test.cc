#include "services/stereo_capture/frame_timing.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

constexpr std::int64_t kPeriodUs = 33'333;
constexpr std::int64_t kEpochUs = 1'700'000'000'000'000;

/// Frame @p n of a camera whose clock began 1000 s before, exposed from the n-th tick on, sent at
/// the exposure's end plus @p readout_us.
CapturedFrame Frame(std::int64_t n, double exposure_us, std::int64_t stamp_after_us,
                    std::int64_t readout_us = 0) {
  CapturedFrame frame;
  frame.id = static_cast<std::uint64_t>(n);
  frame.device_ns = 1000 * (1'000'000'000 + n * kPeriodUs + stamp_after_us);
  frame.arrival_us = kEpochUs + n * kPeriodUs + static_cast<std::int64_t>(exposure_us) + readout_us;
  frame.exposure_us = exposure_us;
  return frame;
}

CameraConfig Config(const std::string& timestamp_at, double readout_ms = 0) {
  CameraConfig config;
  config.timestamp_at = timestamp_at;
  config.readout_ms = readout_ms;
  return config;
}

TEST(FrameTimingTest, GivesTheMiddleOfTheExposureWhateverTheStampMeans) {
  const std::pair<const char*, int> kinds[] = {{"start", 0}, {"middle", 4000}, {"end", 8000}};
  for (const auto& [timestamp_at, stamp_after_us] : kinds) {
    FrameTiming timing(Config(timestamp_at));
    std::optional<std::int64_t> utime_us;
    for (int n = 0; n < 10; ++n) utime_us = timing.Add(Frame(n, 8000, stamp_after_us));
    ASSERT_TRUE(utime_us) << timestamp_at;
    EXPECT_NEAR(static_cast<double>(*utime_us - kEpochUs - 9 * kPeriodUs), 4000, 1) << timestamp_at;
    const auto camera_us = timing.CameraMidUs(Frame(9, 8000, stamp_after_us));
    EXPECT_EQ(camera_us, 1'000'000'000 + 9 * kPeriodUs + 4000);
  }
}

TEST(FrameTimingTest, AnExposureThatChangesDoesNotMoveTheClock) {
  FrameTiming timing(Config("start"));
  for (int n = 0; n < 60; ++n) {
    const double exposure_us = n % 2 ? 2000 : 20'000;
    const auto utime_us = timing.Add(Frame(n, exposure_us, 0));
    if (n < 10) continue;
    ASSERT_TRUE(utime_us);
    EXPECT_NEAR(static_cast<double>(*utime_us - kEpochUs - n * kPeriodUs), exposure_us / 2, 1);
  }
}

TEST(FrameTimingTest, AKnownReadoutIsTakenOut) {
  FrameTiming timing(Config("start", 12));
  std::optional<std::int64_t> utime_us;
  for (int n = 0; n < 10; ++n) utime_us = timing.Add(Frame(n, 8000, 0, 12'000));
  EXPECT_NEAR(static_cast<double>(*utime_us - kEpochUs - 9 * kPeriodUs), 4000, 1);
}

TEST(FrameTimingTest, UnknownExposureCountsAsNone) {
  FrameTiming timing(Config("start"));
  std::optional<std::int64_t> utime_us;
  for (int n = 0; n < 10; ++n) {
    CapturedFrame frame = Frame(n, 0, 0);
    frame.exposure_us = std::nan("");
    utime_us = timing.Add(frame);
  }
  EXPECT_NEAR(static_cast<double>(*utime_us - kEpochUs - 9 * kPeriodUs), 0, 1);
}

TEST(FrameTimingTest, HasNoTimeUntilTheClockIsKnownAndCountsThoseFrames) {
  FrameTiming timing(Config("start"));
  int without = 0;
  for (int n = 0; n < 30; ++n) without += timing.Add(Frame(n, 8000, 0)) ? 0 : 1;
  EXPECT_EQ(without, timing.untimed());
  EXPECT_GE(without, 4);
  EXPECT_LE(without, 6);  // 0.15 s
}

TEST(FrameTimingTest, ANewSessionBeginsAnewAndLosesNothing) {
  FrameTiming timing(Config("start"));
  for (int n = 0; n < 30; ++n) timing.Add(Frame(n, 8000, 0));
  EXPECT_FALSE(timing.restarted());
  CapturedFrame frame = Frame(40, 8000, 0);
  frame.session = 1;
  frame.device_ns -= 900'000'000'000;  // its clock began anew
  frame.id = 3;
  EXPECT_FALSE(timing.Add(frame));
  EXPECT_TRUE(timing.restarted());
  EXPECT_EQ(timing.lost(), 0);
}

TEST(FrameTimingTest, CountsLostFramesByTheirNumbers) {
  FrameTiming timing(Config("start"));
  for (const int n : {0, 1, 2, 5, 6, 10}) timing.Add(Frame(n, 8000, 0));
  EXPECT_EQ(timing.lost(), 2 + 3);
}

TEST(FrameTimingTest, HostTimeNeedsNoMap) {
  FrameTiming timing(Config("start"));
  CapturedFrame frame = Frame(0, 8000, 0);
  frame.is_host_time = true;
  frame.device_ns = 1000 * kEpochUs;
  EXPECT_EQ(timing.Add(frame), kEpochUs);
  EXPECT_EQ(timing.CameraMidUs(frame), kEpochUs);
}

}  // namespace
}  // namespace visavis
