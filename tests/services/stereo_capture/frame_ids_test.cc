#include "services/stereo_capture/frame_ids.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

TEST(FrameIdsTest, CountsTheFramesThatAreMissing) {
  FrameIds ids;
  EXPECT_EQ(ids.Add(500), 0);
  EXPECT_EQ(ids.Add(501), 0);
  EXPECT_EQ(ids.Add(505), 3);
  EXPECT_EQ(ids.Add(506), 0);
}

TEST(FrameIdsTest, TheWrapOf16BitsLosesNothingWithAndWithoutANumber0) {
  FrameIds with;
  for (std::uint64_t n = 65500; n < 65600; ++n) EXPECT_EQ(with.Add(n % 65536), 0) << n;
  FrameIds without;
  for (std::uint64_t n = 65500; n < 65536; ++n) EXPECT_EQ(without.Add(n), 0) << n;
  for (std::uint64_t n = 1; n < 50; ++n) EXPECT_EQ(without.Add(n), 0) << n;
}

TEST(FrameIdsTest, LostFramesRoundTheWrapAreCountedToWithinOne) {
  for (std::uint64_t lost = 1; lost < 20; ++lost) {
    FrameIds ids;
    ids.Add(65530);
    const auto counted = ids.Add((65530 + 1 + lost) % 65536);
    const auto truth = static_cast<std::int64_t>(lost);
    EXPECT_LE(counted, truth);
    EXPECT_GE(counted, truth - 1);
  }
}

TEST(FrameIdsTest, ACameraThatBeginsAnewHasLostNothing) {
  FrameIds ids;
  ids.Add(40000);
  EXPECT_EQ(ids.Add(1), 0);
  EXPECT_EQ(ids.Add(1), 0);  // a number that repeats
  EXPECT_EQ(ids.Add(2), 0);
  ids.Reset();
  EXPECT_EQ(ids.Add(9000), 0);
}

TEST(FrameIdsTest, NumbersOf64BitsDoNotWrapAt16) {
  FrameIds ids;
  ids.Add(65535);
  EXPECT_EQ(ids.Add(65536), 0);
  EXPECT_EQ(ids.Add(65540), 3);
  EXPECT_EQ(ids.Add(70), 0);
}

}  // namespace
}  // namespace visavis
