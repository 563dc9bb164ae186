#include "services/logger/channel_filter.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

TEST(ChannelFilterTest, IncludeAndExcludeFitWholeNames) {
  ChannelFilter filter("HEAD_.*|STEREO_RIG", ".*_TRUTH");
  EXPECT_TRUE(filter.Takes("HEAD_POSE"));
  EXPECT_TRUE(filter.Takes("STEREO_RIG"));
  EXPECT_FALSE(filter.Takes("STEREO_RIG_2"));
  EXPECT_FALSE(filter.Takes("A_HEAD_POSE"));
  EXPECT_FALSE(filter.Takes("HEAD_POSE_TRUTH"));
  EXPECT_TRUE(filter.Takes("HEAD_POSE"));  // and says the same again
}

TEST(ChannelFilterTest, AnEmptyExcludeLeavesNothingOut) {
  ChannelFilter filter(".*", "");
  EXPECT_TRUE(filter.Takes("ANY"));
  EXPECT_TRUE(filter.Takes(""));
}

TEST(ChannelFilterTest, EndlesslyManyNamesAreStillJudgedRight) {
  ChannelFilter filter("A.*", "");
  for (int i = 0; i < 25'000; ++i) {
    EXPECT_TRUE(filter.Takes("A" + std::to_string(i)));
    EXPECT_FALSE(filter.Takes("B" + std::to_string(i)));
  }
}

}  // namespace
}  // namespace visavis
