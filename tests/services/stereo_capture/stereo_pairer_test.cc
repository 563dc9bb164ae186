#include "services/stereo_capture/stereo_pairer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "services/stereo_capture/clock_map.h"
#include "tests/services/stereo_capture/synthetic_camera.h"

namespace visavis {
namespace {

using Pairer = StereoPairer<int>;

TEST(StereoPairerTest, JoinsFramesWithinTheToleranceInEitherOrder) {
  Pairer pairer(5000);
  EXPECT_FALSE(pairer.Add(Side::kLeft, 100'000, 1));
  const auto first = pairer.Add(Side::kRight, 105'000, 1);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->left.utime_us, 100'000);
  EXPECT_EQ(first->right.utime_us, 105'000);
  EXPECT_EQ(first->skew_us(), -5000);
  EXPECT_FALSE(pairer.Add(Side::kRight, 130'000, 2));
  const auto second = pairer.Add(Side::kLeft, 131'000, 2);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->skew_us(), 1000);
  EXPECT_EQ(pairer.unpaired(Side::kLeft) + pairer.unpaired(Side::kRight), 0);
}

TEST(StereoPairerTest, FramesApartByMoreThanTheToleranceAreNeverAPair) {
  Pairer pairer(5000);
  for (int n = 0; n < 100; ++n) {
    EXPECT_FALSE(pairer.Add(Side::kLeft, 33'333 * n, n));
    EXPECT_FALSE(pairer.Add(Side::kRight, 33'333 * n + 5001, n));
  }
  EXPECT_GE(pairer.unpaired(Side::kLeft), 99);
  EXPECT_GE(pairer.unpaired(Side::kRight), 98);
}

TEST(StereoPairerTest, AFrameWithoutPartnerIsGivenUpAndCounted) {
  Pairer pairer(5000);
  pairer.Add(Side::kLeft, 0, 0);
  pairer.Add(Side::kLeft, 33'000, 1);
  const auto pair = pairer.Add(Side::kRight, 33'500, 1);
  ASSERT_TRUE(pair);
  EXPECT_EQ(pair->left.frame, 1);
  EXPECT_EQ(pairer.unpaired(Side::kLeft), 1);
  EXPECT_FALSE(pairer.Add(Side::kRight, 66'000, 2));
  EXPECT_FALSE(pairer.Add(Side::kLeft, 99'000, 3));
  EXPECT_EQ(pairer.unpaired(Side::kRight), 1);
}

TEST(StereoPairerTest, OneSideAloneHoldsAFewFramesAndNoMore) {
  StereoPairer<std::shared_ptr<int>> pairer(5000, 3);
  const auto memory = std::make_shared<int>(0);
  for (int n = 0; n < 50; ++n) {
    pairer.Add(Side::kRight, 33'000 * n, memory);
    EXPECT_LE(memory.use_count(), 1 + 3);
  }
  EXPECT_EQ(pairer.unpaired(Side::kRight), 47);
  pairer.Clear(Side::kRight);
  EXPECT_EQ(memory.use_count(), 1);
  EXPECT_EQ(pairer.unpaired(Side::kRight), 50);
}

/// Two cameras on one trigger through their clock maps; events in order of arrival.
struct Outcome {
  int pairs{0}, wrong{0}, worst_skew_us{0};
};
Outcome PairTwoCameras(SyntheticCamera left, SyntheticCamera right, std::uint64_t frames,
                       double tolerance_share) {
  struct Event {
    Side side;
    SyntheticCamera::Arrival arrival;
  };
  std::vector<Event> events;
  for (std::uint64_t n = 0; n < frames; ++n) {
    if (const auto arrival = left.Frame(n)) events.push_back({Side::kLeft, *arrival});
    if (const auto arrival = right.Frame(n)) events.push_back({Side::kRight, *arrival});
  }
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
    return a.arrival.arrival_us < b.arrival.arrival_us;
  });
  StereoPairer<std::uint64_t> pairer(static_cast<std::int64_t>(tolerance_share * left.period_us));
  std::array<ClockMap, 2> maps;
  Outcome run;
  for (const Event& event : events) {
    ClockMap& map = maps[Index(event.side)];
    map.Add(event.arrival.device_ns, event.arrival.arrival_us);
    if (!map.settled()) continue;
    const auto pair =
        pairer.Add(event.side, map.ToHostUs(event.arrival.device_ns), event.arrival.frame);
    if (!pair) continue;
    ++run.pairs;
    if (pair->left.frame != pair->right.frame) ++run.wrong;
    run.worst_skew_us = std::max(run.worst_skew_us, static_cast<int>(std::abs(pair->skew_us())));
  }
  return run;
}

TEST(StereoPairerTest, ClocksApartAndDriftingGiveEveryPairAndNoneWrong) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SyntheticCamera left, right;
    left.seed = 2 * seed;
    right.seed = 2 * seed + 1;
    left.clock_offset_us = 10'000;  // raw times would pair frames 10 ms apart
    left.drift_ppm = 50;
    right.clock_offset_us = -3e14;
    const Outcome run = PairTwoCameras(left, right, 1800, 0.25);
    EXPECT_EQ(run.wrong, 0) << seed;
    EXPECT_GE(run.pairs, 1800 - 6) << seed;  // what the maps need to settle
    EXPECT_LT(run.worst_skew_us, 400) << seed;
  }
}

TEST(StereoPairerTest, LostFramesCostTheirPairAndNoOther) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SyntheticCamera left, right;
    left.seed = 2 * seed;
    right.seed = 2 * seed + 1;
    left.lost_share = right.lost_share = 0.1;
    left.drift_ppm = -80;
    left.period_us = right.period_us = 1e6 / 60;
    const Outcome run = PairTwoCameras(left, right, 3600, 0.25);
    EXPECT_EQ(run.wrong, 0) << seed;
    EXPECT_NEAR(run.pairs, 3600 * 0.81, 4 * 25 + 10) << seed;  // 4 sigma: sqrt(3600 * .81 * .19)
  }
}

}  // namespace
}  // namespace visavis
