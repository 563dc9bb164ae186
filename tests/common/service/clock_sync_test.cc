#include "common/service/clock_sync.h"

#include <gtest/gtest.h>

#include <cmath>

namespace visavis {
namespace {

timex Disciplined() {
  timex time{};
  time.status = STA_PLL;
  time.esterror = 120;
  time.maxerror = 3000;
  return time;
}

TEST(ClockSyncTest, ADisciplinedClockIsSynchronisedWithItsEstimatedError) {
  const ClockSync sync = InterpretClock(TIME_OK, Disciplined());
  EXPECT_TRUE(sync.synchronised);
  EXPECT_DOUBLE_EQ(sync.offset_s, 120e-6);
  EXPECT_EQ(sync.maximum_error_us, 3000);
}

TEST(ClockSyncTest, WhatIsStillSlewedAwayCountsWhicheverItsSignAndUnit) {
  timex time = Disciplined();
  time.offset = -2000;  // us
  EXPECT_DOUBLE_EQ(InterpretClock(TIME_OK, time).offset_s, 120e-6 + 2000e-6);
  time.status |= STA_NANO;
  EXPECT_DOUBLE_EQ(InterpretClock(TIME_OK, time).offset_s, 120e-6 + 2000e-9);
}

TEST(ClockSyncTest, AnUndisciplinedClockHasAnUnknownError) {
  timex time = Disciplined();
  time.status |= STA_UNSYNC;
  const ClockSync sync = InterpretClock(TIME_OK, time);
  EXPECT_FALSE(sync.synchronised);
  EXPECT_TRUE(std::isnan(sync.offset_s));
  EXPECT_FALSE(InterpretClock(TIME_ERROR, Disciplined()).synchronised);
}

TEST(ClockSyncTest, OfAKernelThatRefusesTheQuestionNothingIsKnown) {
  EXPECT_TRUE(InterpretClock(TIME_ERROR, Disciplined()).known);
  const ClockSync sync = InterpretClock(-1, Disciplined());
  EXPECT_FALSE(sync.known);
  EXPECT_FALSE(sync.synchronised);
  EXPECT_EQ(sync.maximum_error_us, 0);
}

TEST(ClockSyncTest, ALeapSecondIsNoFault) {
  EXPECT_TRUE(InterpretClock(TIME_INS, Disciplined()).synchronised);
}

TEST(ClockSyncTest, ThisHostsClockCanBeAsked) {
  const ClockSync sync = ReadClockSync();
  EXPECT_EQ(std::isnan(sync.offset_s), !sync.synchronised);
}

}  // namespace
}  // namespace visavis
