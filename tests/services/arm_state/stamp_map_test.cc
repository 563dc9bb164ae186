#include "services/arm_state/stamp_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/core/random.h"

namespace visavis {
namespace {

/// A sender's clock that is @p offset_us behind ours and @p drift_ppm fast, 200 stamps a second
/// that take 0.2 ms and mostly more: the largest error of the mapped times after the first second.
double WorstErrorMs(double offset_us, double drift_ppm) {
  StampMap map;
  Random random(1);
  double worst_us = 0, arrival_us = 0;
  for (int i = 0; i < 6000; ++i) {
    const double true_us = 1e12 + 5000.0 * i;
    const double stamp_us = (true_us - 1e12) * (1 + 1e-6 * drift_ppm) - offset_us + 1e12;
    const double delay_us = 200 - 2000 * std::log(1 - random.Uniform());
    arrival_us = std::max(arrival_us, true_us + delay_us);  // none overtakes another
    const std::int64_t mapped = map.Map(std::llround(stamp_us), std::llround(arrival_us));
    if (i > 200) worst_us = std::max(worst_us, std::abs(static_cast<double>(mapped) - true_us));
  }
  return 1e-3 * worst_us;
}

// The shortest of 400 exponential delays of mean 2 ms is within 0.1 ms of the least, but for one
// chance in e^20; drift adds 2 s times its rate.
TEST(StampMapTest, AnOffsetIsMappedToWithinTheShortestWay) {
  EXPECT_LT(WorstErrorMs(0, 0), 0.3);
  EXPECT_LT(WorstErrorMs(10'000, 0), 0.3);
  EXPECT_LT(WorstErrorMs(-3.6e9, 0), 0.3);
}

TEST(StampMapTest, ADriftIsFollowed) {
  EXPECT_LT(WorstErrorMs(10'000, 50), 0.4);
  EXPECT_LT(WorstErrorMs(10'000, -50), 0.4);
}

TEST(StampMapTest, TimesComeInOrderWhenAShorterWayIsFound) {
  StampMap map;
  const std::int64_t first = map.Map(1000, 50'000), second = map.Map(2000, 10'000);
  EXPECT_EQ(first, 50'000);
  EXPECT_EQ(second, 50'001);
  EXPECT_EQ(map.Map(60'000, 70'000), 68'000);
}

TEST(StampMapTest, ALongWayAloneMovesNothing) {
  StampMap map;
  for (int i = 0; i < 100; ++i) map.Map(10'000 * i, 5'000'000 + 10'000 * i);
  EXPECT_EQ(map.Map(1'000'000, 6'400'000), 6'000'000);
}

TEST(StampMapTest, WhatIsOlderThanTwoSecondsIsForgotten) {
  StampMap map;
  map.Map(0, 1'000'000);
  EXPECT_EQ(map.Map(1'500'000, 2'600'000), 2'500'000);
  EXPECT_EQ(map.Map(4'000'000, 5'100'000), 5'100'000);
}

TEST(StampMapTest, AHostsClockThatWasSetBackStartsItAnew) {
  StampMap map;
  map.Map(0, 100'000'000);
  EXPECT_EQ(map.Map(10'000, 50'000'000), 50'000'000);
}

}  // namespace
}  // namespace visavis
