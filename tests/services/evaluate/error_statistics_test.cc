#include "services/evaluate/error_statistics.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

TEST(ErrorStatisticsTest, StatisticsOfSignedValues) {
  const auto s = ComputeStatistics({-3, 1, 5});
  ASSERT_TRUE(s);
  EXPECT_DOUBLE_EQ(s->rmse, std::sqrt(35 / 3.0));
  EXPECT_DOUBLE_EQ(s->mean, 3);
  EXPECT_DOUBLE_EQ(s->max, 5);
  EXPECT_DOUBLE_EQ(s->bias, 1);
  EXPECT_FALSE(ComputeStatistics({}));
}

TEST(ErrorStatisticsTest, BiasOfTheNormIsTheLengthOfTheMeanError) {
  RecognitionError a{{3, 0, 0}, {0.1, 0, 0}, 0.1}, b{{-3, 0, 8}, {-0.1, 0.2, 0}, 0.3};
  const ErrorStatistics s = ComputeErrorStatistics({a, b});
  EXPECT_DOUBLE_EQ(s.position_norm_m->bias, 4);
  EXPECT_DOUBLE_EQ(s.position_norm_m->mean, (3 + std::sqrt(73.0)) / 2);
  EXPECT_DOUBLE_EQ(s.total_angle_rad->bias, 0.1);
  EXPECT_DOUBLE_EQ(s.total_angle_rad->max, 0.3);
}

TEST(ErrorStatisticsTest, QuantilesInterpolate) {
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 0), 1);
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 0.9), 3.7);
  EXPECT_DOUBLE_EQ(*Quantile({4, 1, 3, 2}, 1), 4);
  EXPECT_DOUBLE_EQ(*Quantile({7}, 0.99), 7);
  EXPECT_FALSE(Quantile({}, 0.5));
}

}  // namespace
}  // namespace visavis
