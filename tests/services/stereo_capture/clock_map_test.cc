#include "services/stereo_capture/clock_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/services/stereo_capture/synthetic_camera.h"

namespace visavis {
namespace {

using Verdict = ClockMap::Verdict;

/// Largest error [us] of the mapped times of frames from @p from_s to @p to_s.
double WorstError(SyntheticCamera camera, double from_s, double to_s) {
  ClockMap map;
  double worst_us = 0;
  for (std::uint64_t n = 0; static_cast<double>(n) * camera.period_us < 1e6 * to_s; ++n) {
    const auto frame = camera.Frame(n);
    if (!frame) continue;
    EXPECT_EQ(map.Add(frame->device_ns, frame->arrival_us), Verdict::kTaken) << n;
    if (static_cast<double>(n) * camera.period_us < 1e6 * from_s) continue;
    EXPECT_TRUE(map.settled()) << n;
    const auto error = static_cast<double>(map.ToHostUs(frame->device_ns) - frame->true_us);
    worst_us = std::max(worst_us, std::abs(error));
  }
  return worst_us;
}

// Least of 60 exponential delays of mean 200 us: 3 us in the mean, below 50 us with 1 - 3e-7.
TEST(ClockMapTest, AnyEpochIsMappedToWithinTheLeastDelay) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SyntheticCamera camera;
    camera.seed = seed;
    EXPECT_LT(WorstError(camera, 2, 20), 150 + 50) << seed;
    EXPECT_GT(WorstError(camera, 2, 20), 150 - 1) << seed;
  }
}

TEST(ClockMapTest, ADriftingClockIsFollowed) {
  for (const double drift_ppm : {-100.0, -50.0, 50.0, 100.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SyntheticCamera camera;
      camera.seed = seed;
      camera.drift_ppm = drift_ppm;
      // Before the drift is known the minimum of 2 s is that of its oldest or newest frame.
      EXPECT_LT(WorstError(camera, 0.5, 4), 200 + 2 * std::abs(drift_ppm) + 150);
      EXPECT_LT(WorstError(camera, 8, 60), 150 + 60) << drift_ppm << " " << seed;
    }
  }
}

TEST(ClockMapTest, TheDriftItselfIsFound) {
  SyntheticCamera camera;
  camera.drift_ppm = 50;
  ClockMap map;
  EXPECT_EQ(map.drift_ppm(), 0);
  for (std::uint64_t n = 0; n < 450; ++n) {
    const auto frame = camera.Frame(n);
    map.Add(frame->device_ns, frame->arrival_us);
  }
  EXPECT_NEAR(map.drift_ppm(), -50, 8);  // 40 us of residual delay over half of 10 s
}

TEST(ClockMapTest, LostFramesAndSlowCamerasDoNotHurt) {
  SyntheticCamera camera;
  camera.lost_share = 0.4;
  camera.drift_ppm = 30;
  EXPECT_LT(WorstError(camera, 8, 30), 150 + 100);
  camera.lost_share = 0;
  camera.period_us = 0.5e6;
  camera.mean_jitter_us = 20;
  EXPECT_LT(WorstError(camera, 8, 60), 150 + 100);
  camera.period_us = 1e6 / 500;
  EXPECT_LT(WorstError(camera, 8, 20), 150 + 20);
}

TEST(ClockMapTest, IsNotSettledBeforeEnoughFramesAgree) {
  ClockMap map;
  EXPECT_FALSE(map.settled());
  EXPECT_EQ(map.ToHostUs(5), 0);
  for (int n = 0; n < 4; ++n) {
    map.Add(n * 33'000'000LL, 1'000'000 + n * 33'000 + 20'000);
    EXPECT_FALSE(map.settled()) << n;
  }
  // These come 20 ms sooner: the first four were late, and a minimum needs company.
  int n = 4;
  for (; n < 8; ++n) {
    map.Add(n * 33'000'000LL, 1'000'000 + n * 33'000);
    EXPECT_FALSE(map.settled()) << n;
  }
  map.Add(n * 33'000'000LL, 1'000'000 + n * 33'000);
  EXPECT_TRUE(map.settled());
  map.Reset();
  EXPECT_FALSE(map.settled());
}

TEST(ClockMapTest, OneSenselessTimeIsAnOutlierAndChangesNothing) {
  SyntheticCamera camera;
  ClockMap map;
  for (std::uint64_t n = 0; n < 60; ++n) {
    const auto frame = camera.Frame(n);
    map.Add(frame->device_ns, frame->arrival_us);
  }
  const auto frame = camera.Frame(60);
  const auto before = map.ToHostUs(frame->device_ns);
  EXPECT_EQ(map.Add(0, frame->arrival_us), Verdict::kOutlier);  // back
  EXPECT_EQ(map.Add(frame->device_ns + 900'000'000, frame->arrival_us), Verdict::kOutlier);
  EXPECT_EQ(map.ToHostUs(frame->device_ns), before);
  EXPECT_EQ(map.Add(frame->device_ns, frame->arrival_us), Verdict::kTaken);
}

TEST(ClockMapTest, AClockThatWasSetBeginsAnewAfterFourFrames) {
  for (const std::int64_t step_us : {-5'000'000'000LL, -900'000LL, 900'000LL, 37'000'000LL}) {
    SyntheticCamera camera;
    ClockMap map;
    for (std::uint64_t n = 0; n < 90; ++n) {
      const auto frame = camera.Frame(n);
      map.Add(frame->device_ns, frame->arrival_us);
    }
    for (std::uint64_t n = 90; n < 120; ++n) {
      const auto frame = camera.Frame(n);
      const auto verdict = map.Add(frame->device_ns + 1000 * step_us, frame->arrival_us);
      EXPECT_EQ(verdict, n < 93    ? Verdict::kOutlier
                         : n == 93 ? Verdict::kRestarted
                                   : Verdict::kTaken)
          << step_us << " " << n;
      EXPECT_EQ(map.settled(), n < 93 || n > 97) << n;
      if (n < 105) continue;
      EXPECT_TRUE(map.settled());
      EXPECT_NEAR(static_cast<double>(map.ToHostUs(frame->device_ns + 1000 * step_us)),
                  static_cast<double>(frame->true_us), 150 + 300);
    }
  }
}

TEST(ClockMapTest, ALinkThatIsSlowForAWhileDoesNotShiftTheTime) {
  SyntheticCamera camera;
  ClockMap map;
  for (std::uint64_t n = 0; n < 300; ++n) {
    const auto frame = camera.Frame(n);
    const bool slow = n >= 150 && n < 180;  // one second: a minimum of 2 s bridges it
    map.Add(frame->device_ns, frame->arrival_us + (slow ? 20'000 : 0));
    if (n > 60) {
      EXPECT_LT(std::abs(map.ToHostUs(frame->device_ns) - frame->true_us), 150 + 100) << n;
    }
  }
}

}  // namespace
}  // namespace visavis
