#include "services/logger/channel_filter.h"

#include <gtest/gtest.h>

#include "services/logger/log_name.h"

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

TEST(LogNameTest, NamesSortByTimeInUtc) {
  EXPECT_EQ(LogName("visavis", 0, 0), "visavis-19700101T000000Z.lcm");
  EXPECT_EQ(LogName("run", 1'732'295'101'999'999, 0), "run-20241122T170501Z.lcm");
  EXPECT_EQ(LogName("run", 1'732'295'101'999'999, 2), "run-20241122T170501Z-2.lcm");
}

}  // namespace
}  // namespace visavis
