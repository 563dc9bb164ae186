#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>

#include "common/core/check.h"
#include "common/core/clock.h"
#include "common/core/random.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kDraws = 100'000;
// An estimate from kDraws numbers misses its mean by more than five standard errors once in two
// million seeds; the seeds here are fixed.
const double kFiveSigma = 5 / std::sqrt(kDraws);

TEST(CheckTest, NamesFunctionConditionAndValue) {
  const int fingers = 6;
  EXPECT_THAT([&] { VISAVIS_THROW_UNLESS(fingers <= 5, fingers); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("'fingers <= 5'"), HasSubstr("fingers = 6"))));
  EXPECT_NO_THROW(VISAVIS_THROW_UNLESS(fingers == 6, fingers));
}

TEST(ClockTest, SystemClockIsUnixTimeInMicroseconds) {
  const auto seconds_now = [] { return static_cast<std::int64_t>(std::time(nullptr)); };
  const std::int64_t before_s = seconds_now();
  const std::int64_t now_us = SystemClock().NowUs();
  EXPECT_GE(now_us, before_s * 1'000'000);
  EXPECT_LT(now_us, (seconds_now() + 1) * 1'000'000);
}

TEST(ClockTest, ManualClockShowsWhatItWasSetTo) {
  ManualClock clock;
  EXPECT_EQ(clock.NowUs(), 0);
  clock.Set(5);
  clock.Set(3);
  EXPECT_EQ(clock.NowUs(), 3);
}

TEST(ClockTest, MonotonicSecondsNeverGoBack) {
  double last = MonotonicSeconds();
  for (int i = 0; i < 1000; ++i) {
    const double now = MonotonicSeconds();
    EXPECT_GE(now, last);
    last = now;
  }
}

// The standard fixes the 10000th number of a mt19937_64 with its default seed; from there the
// definitions of this class follow by hand.
TEST(RandomTest, IsTheSameOnEveryMachine) {
  Random random(5489);
  std::uint64_t bits = 0;
  for (int i = 0; i < 10000; ++i) bits = random.Bits();
  EXPECT_EQ(bits, 9981545732273789042u);
  Random twin(5489);
  for (int i = 0; i < 9999; ++i) twin.Bits();
  EXPECT_EQ(twin.Uniform(), static_cast<double>(9981545732273789042u >> 11) / 9007199254740992.0);
}

TEST(RandomTest, EqualSeedsDrawEqualNumbersAndOthersDoNot) {
  Random a(3), b(3), c(4);
  bool all_equal = true;
  for (int i = 0; i < 100; ++i) {
    const double x = a.Normal();
    EXPECT_EQ(x, b.Normal());
    all_equal = all_equal && x == c.Normal();
  }
  EXPECT_FALSE(all_equal);
}

TEST(RandomTest, UniformIsFlatOverItsRange) {
  Random random(1);
  double sum = 0, sum_of_squares = 0, min = 10, max = -10;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Uniform(-2, 4);
    sum += x;
    sum_of_squares += x * x;
    min = std::min(min, x);
    max = std::max(max, x);
  }
  EXPECT_GE(min, -2);
  EXPECT_LT(max, 4);
  EXPECT_LT(min, -2 + 6 * 20.0 / kDraws);  // missed with probability exp(-20)
  EXPECT_GT(max, 4 - 6 * 20.0 / kDraws);
  // U(-2, 4): mean 1, variance 36 / 12, E[x^2] = 4, Var[x^2] = E[x^4] - 16 = 1056 / 30 - 16.
  EXPECT_NEAR(sum / kDraws, 1, std::sqrt(3.0) * kFiveSigma);
  EXPECT_NEAR(sum_of_squares / kDraws, 4, std::sqrt(1056.0 / 30 - 16) * kFiveSigma);
}

TEST(RandomTest, IndexDrawsEachNumberEquallyOftenAndNoOther) {
  Random random(2);
  std::array<int, 7> counts{};
  for (int i = 0; i < kDraws; ++i) {
    const int index = random.Index(7);
    ASSERT_GE(index, 0);
    ASSERT_LT(index, 7);
    ++counts[static_cast<std::size_t>(index)];
  }
  const double p = 1.0 / 7;
  for (const int count : counts) {
    EXPECT_NEAR(static_cast<double>(count) / kDraws, p, std::sqrt(p * (1 - p)) * kFiveSigma);
  }
}

TEST(RandomTest, IndexReachesBothEndsOfTheLargestRange) {
  constexpr int kLargest = std::numeric_limits<int>::max();
  Random random(3);
  int min = kLargest, max = 0;
  for (int i = 0; i < kDraws; ++i) {
    const int index = random.Index(kLargest);
    min = std::min(min, index);
    max = std::max(max, index);
  }
  EXPECT_GE(min, 0);
  EXPECT_LT(min, kLargest / (kDraws / 20));
  EXPECT_GT(max, kLargest - kLargest / (kDraws / 20));
  EXPECT_EQ(random.Index(1), 0);
}

TEST(RandomTest, NormalHasMeanZeroVarianceOneAndTheTailsOfABell) {
  Random random(4);
  double sum = 0, sum_of_squares = 0;
  int beyond_two = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    sum_of_squares += x * x;
    if (std::abs(x) > 2) ++beyond_two;
  }
  EXPECT_NEAR(sum / kDraws, 0, kFiveSigma);
  EXPECT_NEAR(sum_of_squares / kDraws, 1, std::sqrt(2.0) * kFiveSigma);
  const double p = std::erfc(2 / std::sqrt(2.0));
  EXPECT_NEAR(static_cast<double>(beyond_two) / kDraws, p, std::sqrt(p * (1 - p)) * kFiveSigma);
}

}  // namespace
}  // namespace visavis
