#include "services/recogniser/refined/distance_ranges.h"

#include <gtest/gtest.h>

#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

SearchSpace Between(double min_z, double max_z) {
  SearchSpace space;
  space.min << -0.2, -0.3, min_z, -1, -0.5, -0.5;
  space.max << 0.2, 0.3, max_z, 1, 0.5, 0.5;
  return space;
}

TEST(DistanceRangesTest, ASpaceOfAnOctaveStaysWhole) {
  for (const double max_z : {1.2, 1.8}) {
    const SearchSpace space = Between(0.9, max_z);
    const DistanceRanges ranges(TestRig(), space);
    ASSERT_EQ(ranges.size(), 1u);
    EXPECT_EQ(ranges.space(0).min, space.min);
    EXPECT_EQ(ranges.space(0).max, space.max);
  }
}

TEST(DistanceRangesTest, ADeeperSpaceIsCutIntoEqualRatiosWithoutAGap) {
  const SearchSpace space = Between(0.4, 3.0);
  const DistanceRanges ranges(TestRig(), space);
  ASSERT_EQ(ranges.size(), 3u);
  EXPECT_EQ(ranges.space(0).min, space.min);
  EXPECT_EQ(ranges.space(2).max, space.max);
  for (std::size_t i = 0; i < 3; ++i) {
    const SearchSpace& part = ranges.space(i);
    EXPECT_NEAR(part.max[2] / part.min[2], std::cbrt(7.5), 1e-9);
    EXPECT_EQ(part.min.tail<3>(), space.min.tail<3>());
    EXPECT_EQ(part.max.head<2>(), space.max.head<2>());
    if (i > 0) {
      EXPECT_EQ(part.min[2], ranges.space(i - 1).max[2]);
    }
  }
}

TEST(DistanceRangesTest, NearHeadsAreSeenInHalvedPicturesFarOnesInDoubledWindows) {
  const DistanceRanges ranges(TestRig(), Between(0.4, 3.0));
  EXPECT_EQ(ranges.pair(0).halvings(), 1);
  EXPECT_EQ(ranges.pair(1).halvings(), 0);
  EXPECT_FALSE(ranges.pair(1).is_doubled());
  EXPECT_TRUE(ranges.pair(2).is_doubled());
  EXPECT_GE(ranges.width(), 640);
  EXPECT_GE(ranges.height(), ranges.pair(2).eye(0).height);
}

TEST(DistanceRangesTest, AHeadAtABorderStaysInItsPart) {
  const DistanceRanges ranges(TestRig(), Between(0.5, 2.0));
  ASSERT_EQ(ranges.size(), 2u);  // cut at 1 m
  EXPECT_EQ(ranges.At(0.6), 0u);
  EXPECT_EQ(ranges.At(1.4), 1u);
  EXPECT_EQ(ranges.At(0.1), 0u);
  EXPECT_EQ(ranges.At(9), 1u);
  EXPECT_EQ(ranges.At(1.03, 0), 0u);
  EXPECT_EQ(ranges.At(0.97, 1), 1u);
  EXPECT_EQ(ranges.At(1.1, 0), 1u);
  EXPECT_EQ(ranges.At(0.9, 1), 0u);
}

}  // namespace
}  // namespace visavis
