#include "common/kinematics/sample_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::int64_t kMs = 1000;  // [us]

/// A ring of @p n samples every 10 ms from 1 s on.
SampleTimes Regular(int n, const HistoryOptions& options = {}) {
  SampleTimes times(options);
  for (int i = 0; i < n; ++i) times.Push(1000 * kMs + i * 10 * kMs);
  return times;
}

TEST(SampleTimesTest, EmptyRingKnowsNothing) {
  const SampleTimes times({});
  EXPECT_EQ(times.size(), 0);
  EXPECT_FALSE(times.newest_us());
  EXPECT_FALSE(times.Find(0));
  EXPECT_EQ(times.Judge(0), SampleVerdict::kAccepted);
}

TEST(SampleTimesTest, BracketsATimeByItsNeighbours) {
  const SampleTimes times = Regular(5);
  const auto bracket = times.Find(1013 * kMs);
  ASSERT_TRUE(bracket);
  EXPECT_EQ(bracket->t_0_us, 1010 * kMs);
  EXPECT_EQ(bracket->t_1_us, 1020 * kMs);
  EXPECT_EQ(bracket->slot_0, 1);
  EXPECT_EQ(bracket->slot_1, 2);
  EXPECT_FALSE(bracket->extrapolated);
  EXPECT_EQ(bracket->age_us, 3 * kMs);
}

TEST(SampleTimesTest, SampleAtTheTimeHasAgeZeroAndIsNoExtrapolation) {
  const SampleTimes times = Regular(5);
  for (int i = 0; i < 5; ++i) {
    const auto bracket = times.Find(1000 * kMs + i * 10 * kMs);
    ASSERT_TRUE(bracket);
    EXPECT_EQ(bracket->age_us, 0);
    EXPECT_FALSE(bracket->extrapolated);
  }
}

TEST(SampleTimesTest, ExtrapolatesByOnePeriodAtMost) {
  const SampleTimes times = Regular(5);
  const auto bracket = times.Find(1050 * kMs);
  ASSERT_TRUE(bracket);
  EXPECT_TRUE(bracket->extrapolated);
  EXPECT_EQ(bracket->age_us, 10 * kMs);
  EXPECT_FALSE(times.Find(1050 * kMs + 1));
}

TEST(SampleTimesTest, PeriodIsTheMedianSoThatOneLateSampleDoesNotChangeIt) {
  SampleTimes times = Regular(9);
  times.Push(1080 * kMs + 90 * kMs);  // eight intervals of 10 ms and one of 90
  EXPECT_TRUE(times.Find(1180 * kMs));
  EXPECT_FALSE(times.Find(1181 * kMs));
}

TEST(SampleTimesTest, NothingIsKnownBeforeTheOldestSample) {
  EXPECT_FALSE(Regular(5).Find(1000 * kMs - 1));
  EXPECT_FALSE(Regular(5).Find(-1));
}

TEST(SampleTimesTest, OneSampleIsKnownAtItsTimeOnly) {
  const SampleTimes times = Regular(1);
  const auto bracket = times.Find(1000 * kMs);
  ASSERT_TRUE(bracket);
  EXPECT_EQ(bracket->slot_0, bracket->slot_1);
  EXPECT_FALSE(times.Find(1000 * kMs + 1));
}

TEST(SampleTimesTest, GapsAreNotInterpolated) {
  SampleTimes times = Regular(3);  // newest at 1020 ms
  times.Push(1121 * kMs);
  times.Push(1131 * kMs);
  EXPECT_FALSE(times.Find(1020 * kMs + 1));
  EXPECT_FALSE(times.Find(1121 * kMs - 1));
  const auto before = times.Find(1020 * kMs), after = times.Find(1121 * kMs);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->t_0_us, 1010 * kMs);  // the pair before the gap
  EXPECT_EQ(before->t_1_us, 1020 * kMs);
  EXPECT_EQ(after->t_0_us, 1121 * kMs);  // the pair after it
}

TEST(SampleTimesTest, LoneSampleBetweenTwoGapsIsKnownAtItsTime) {
  SampleTimes times({});
  for (const int ms : {1000, 1500, 2000}) times.Push(ms * kMs);
  const auto bracket = times.Find(1500 * kMs);
  ASSERT_TRUE(bracket);
  EXPECT_EQ(bracket->slot_0, 1);
  EXPECT_EQ(bracket->slot_1, 1);
  EXPECT_FALSE(times.Find(1501 * kMs));
}

TEST(SampleTimesTest, FullRingForgetsTheOldest) {
  const SampleTimes times = Regular(100, {8, 100 * kMs});
  EXPECT_EQ(times.size(), 8);
  EXPECT_EQ(times.newest_us(), 1990 * kMs);
  EXPECT_FALSE(times.Find(1920 * kMs - 1));
  for (int i = 92; i < 99; ++i) {
    const auto bracket = times.Find(1000 * kMs + i * 10 * kMs + 1);
    ASSERT_TRUE(bracket);
    EXPECT_EQ(bracket->t_0_us, 1000 * kMs + i * 10 * kMs);
    EXPECT_EQ(bracket->slot_0, i % 8);
    EXPECT_EQ(bracket->slot_1, (i + 1) % 8);
  }
}

TEST(SampleTimesTest, DuplicatesAndLateSamplesAreJudged) {
  const SampleTimes times = Regular(5);  // newest at 1040 ms
  EXPECT_EQ(times.Judge(1040 * kMs + 1), SampleVerdict::kAccepted);
  EXPECT_EQ(times.Judge(1040 * kMs), SampleVerdict::kDuplicate);
  EXPECT_EQ(times.Judge(1040 * kMs - 1), SampleVerdict::kOutOfOrder);
  EXPECT_EQ(times.Judge(40 * kMs), SampleVerdict::kOutOfOrder);  // back by 1 s exactly
  EXPECT_EQ(times.Judge(-1), SampleVerdict::kOutOfOrder);
  EXPECT_EQ(times.Judge(std::numeric_limits<std::int64_t>::min()), SampleVerdict::kOutOfOrder);
}

TEST(SampleTimesTest, JumpBackByMoreThanASecondIsANewSession) {
  SampleTimes times = Regular(5);
  const std::int64_t back = 40 * kMs - 1;
  EXPECT_EQ(times.Judge(back), SampleVerdict::kAccepted);
  EXPECT_TRUE(times.IsRestart(back));
  times.Push(back);
  EXPECT_EQ(times.size(), 1);
  EXPECT_EQ(times.newest_us(), back);
  EXPECT_FALSE(times.Find(1020 * kMs));
}

TEST(SampleTimesTest, OneTimeFarAheadDoesNotStopTheSession) {
  SampleTimes times = Regular(5);
  times.Push(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(times.Judge(1050 * kMs), SampleVerdict::kAccepted);
  times.Push(1050 * kMs);
  EXPECT_EQ(times.Judge(1060 * kMs), SampleVerdict::kAccepted);
}

TEST(SampleTimesTest, CountsEachVerdictOnce) {
  SampleCounts counts;
  for (const auto verdict :
       {SampleVerdict::kAccepted, SampleVerdict::kDuplicate, SampleVerdict::kOutOfOrder,
        SampleVerdict::kNotFinite, SampleVerdict::kWrongNames, SampleVerdict::kNotRigid}) {
    const std::int64_t before = counts.accepted + counts.rejected();
    counts.Count(verdict);
    EXPECT_EQ(counts.accepted + counts.rejected(), before + 1) << Name(verdict);
  }
  EXPECT_EQ(counts.accepted, 1);
  EXPECT_EQ(counts.rejected(), 5);
}

TEST(SampleTimesTest, RefusesOptionsByName) {
  EXPECT_THAT(
      [] {
        SampleTimes({1, 1000});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("options.capacity = 1")));
  EXPECT_THAT(
      [] {
        SampleTimes({8, 0});
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("options.max_gap_us = 0")));
}

}  // namespace
}  // namespace visavis
