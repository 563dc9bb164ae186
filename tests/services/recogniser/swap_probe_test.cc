#include "services/recogniser/swap_probe.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

double FrozenTime() { return 0; }

/// Says what it is told to say.
class TalkingEstimator final : public Estimator {
 public:
  explicit TalkingEstimator(const bool* sees_head) : sees_head_(*sees_head) {}
  const Estimate& Process(const StereoFrame&, const CameraStep&, StageTimer*) override {
    estimate_.status = sees_head_ ? TrackStatus::kTracking : TrackStatus::kSearching;
    return estimate_;
  }
  void Reset() override {}
  void SetFeedforward(FeedforwardMode) override {}
  void SetSearchSpace(const SearchSpace&) override {}
  const std::vector<Individual>& population() const override { return population_; }
  std::int64_t total_generations() const override { return 0; }

 private:
  const bool& sees_head_;
  Estimate estimate_;
  std::vector<Individual> population_;
};

class SwapProbeTest : public ::testing::Test {
 protected:
  /// Shows @p pairs pairs in which no head is tracked. @return how many were tried exchanged.
  int Show(int pairs) {
    int tries = 0;
    for (int i = 0; i < pairs; ++i) {
      if (!probe_.IsDue(false)) continue;
      probe_.Try({}, &timer_);
      ++tries;
    }
    return tries;
  }
  bool sees_head_{false};
  int made_{0};
  StageTimer timer_{&FrozenTime};
  SwapProbe probe_{[this] {
    ++made_;
    return std::make_unique<TalkingEstimator>(&sees_head_);
  }};
};

TEST_F(SwapProbeTest, WhileAHeadIsTrackedNothingIsTried) {
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(probe_.IsDue(true));
  EXPECT_EQ(made_, 0);
}

TEST_F(SwapProbeTest, AnEmptyRoomIsTriedLessAndLessOften) {
  EXPECT_EQ(Show(6), 1);
  EXPECT_EQ(Show(12), 1);
  EXPECT_EQ(Show(24), 1);
  Show(48);
  EXPECT_EQ(Show(960), 10);
  EXPECT_FALSE(probe_.found());
  EXPECT_EQ(made_, 1);
}

TEST_F(SwapProbeTest, ThreeHeadsInARowAmongExchangedPairsProveIt) {
  sees_head_ = true;
  EXPECT_EQ(Show(2 * SwapProbe::kPeriod), 2);
  EXPECT_FALSE(probe_.found());
  Show(SwapProbe::kPeriod);
  EXPECT_TRUE(probe_.found());
}

TEST_F(SwapProbeTest, OneThatFailsBetweenBeginsAnew) {
  sees_head_ = true;
  Show(2 * SwapProbe::kPeriod);
  sees_head_ = false;
  Show(SwapProbe::kPeriod);
  sees_head_ = true;
  Show(2 * SwapProbe::kPeriod);
  EXPECT_FALSE(probe_.found());
}

TEST_F(SwapProbeTest, AHeadTrackedWithoutTheExchangeTakesItBack) {
  sees_head_ = true;
  Show(3 * SwapProbe::kPeriod);
  ASSERT_TRUE(probe_.found());
  EXPECT_FALSE(probe_.IsDue(true));
  EXPECT_FALSE(probe_.found());
}

}  // namespace
}  // namespace visavis
