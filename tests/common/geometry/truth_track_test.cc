#include "common/geometry/truth_track.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

RigidTransform At(double x_m, double angle_deg = 0) {
  return MakeTransform(ExpRotation({0, angle_deg * M_PI / 180, 0}), Eigen::Vector3d(x_m, 0, 1));
}

TruthSample Sample(std::int64_t utime_us, double x_m, double angle_deg = 0) {
  return {utime_us, At(x_m, angle_deg), {}};
}

TEST(TruthTrackTest, SynchronousTruthIsKnownAtItsOwnTimesAlone) {
  // Frame 2's row is missing: unknown, although its neighbours are known.
  const TruthTrack track({Sample(0, 0), Sample(100, 1e-3), Sample(300, 3e-3)}, {0, 100, 200, 300});
  EXPECT_TRUE(track.is_synchronous());
  ASSERT_TRUE(track.At(100));
  EXPECT_EQ(track.At(100)->X_CM->translation().x(), 1e-3);
  EXPECT_FALSE(track.At(200));
  EXPECT_FALSE(track.At(400));
}

TEST(TruthTrackTest, DroppedFramesDoNotMakeTruthAsynchronous) {
  std::vector<TruthSample> samples;
  samples.reserve(100);
  for (std::int64_t i = 0; i < 100; ++i) samples.push_back(Sample(1000 * i, 0));
  EXPECT_TRUE(TruthTrack(samples, {7000, 50000, 93000}).is_synchronous());
}

TEST(TruthTrackTest, AsynchronousTruthIsInterpolatedOverShortGaps) {
  const TruthTrack track({Sample(0, 0), Sample(100'000, 0.01), Sample(200'001, 0.02)},
                         {25'000, 150'000});
  EXPECT_FALSE(track.is_synchronous());
  ASSERT_TRUE(track.At(25'000));
  EXPECT_NEAR(track.At(25'000)->X_CM->translation().x(), 0.0025, 1e-12);
  EXPECT_FALSE(track.At(150'000));  // 100.001 ms between the neighbours
  EXPECT_FALSE(track.At(-1));
  EXPECT_FALSE(track.At(300'000));
}

TEST(TruthTrackTest, JumpsAreBeyond30MmOr10Deg) {
  const TruthTrack track({Sample(0, 0), Sample(1, 0.029), Sample(2, 0.060), Sample(3, 0.060, 9.9),
                          Sample(4, 0.060, 20)},
                         {});
  EXPECT_THAT(track.jump_utimes_us(), ElementsAre(2, 4));
}

TEST(TruthTrackTest, TheCamerasOwnMotionIsNoJump) {
  // The camera moves by 50 mm a frame past a head at rest; then the head moves by 50 mm.
  std::vector<TruthSample> samples;
  samples.reserve(6);
  for (int i = 0; i < 5; ++i) samples.push_back({i, At(-0.05 * i), At(0)});
  samples.push_back({5, At(-0.20), At(0.05)});
  EXPECT_THAT(TruthTrack(samples, {}).jump_utimes_us(), ElementsAre(5));
}

TEST(TruthTrackTest, AHeadThatComesBackJumpsAndOneThatLeavesDoesNot) {
  const TruthTrack track({Sample(0, 0), {1, {}, {}}, {2, {}, {}}, Sample(3, 0)}, {0, 1, 2, 3});
  EXPECT_THAT(track.jump_utimes_us(), ElementsAre(3));
  ASSERT_TRUE(track.At(1));
  EXPECT_FALSE(track.At(1)->X_CM);
}

TEST(TruthTrackTest, NothingIsInterpolatedAcrossAJumpOrToAHeadThatIsAway) {
  const TruthTrack track({Sample(0, 0), Sample(10'000, 0.1), {20'000, {}, {}}, {30'000, {}, {}}},
                         {5000, 15'000, 25'000, 6000, 16'000, 26'000});
  ASSERT_FALSE(track.is_synchronous());
  EXPECT_FALSE(track.At(5000));
  EXPECT_FALSE(track.At(15'000));
  ASSERT_TRUE(track.At(25'000));
  EXPECT_FALSE(track.At(25'000)->X_CM);
}

TEST(TruthTrackTest, AFrameWithinAMillisecondOfASampleAtAJumpIsThatSamplesExposure) {
  const TruthTrack track({Sample(0, 0), Sample(10'000, 0.1), {20'000, {}, {}}, {30'000, {}, {}}},
                         {1, 9001, 10'999, 19'001});
  ASSERT_FALSE(track.is_synchronous());
  ASSERT_TRUE(track.At(1000));
  EXPECT_EQ(track.At(1000)->X_CM->translation().x(), 0);
  EXPECT_FALSE(track.At(1001));
  EXPECT_FALSE(track.At(8999));
  ASSERT_TRUE(track.At(9000));
  EXPECT_EQ(track.At(9000)->X_CM->translation().x(), 0.1);
  ASSERT_TRUE(track.At(10'999));
  EXPECT_EQ(track.At(10'999)->X_CM->translation().x(), 0.1);
  ASSERT_TRUE(track.At(19'001));
  EXPECT_FALSE(track.At(19'001)->X_CM);
  EXPECT_THAT(track.jump_utimes_us(), ElementsAre(9000));
}

TEST(TruthTrackTest, WithoutTruthNothingIsKnown) {
  const TruthTrack track({}, {0, 1});
  EXPECT_FALSE(track.At(0));
  EXPECT_THAT(track.jump_utimes_us(), IsEmpty());
}

}  // namespace
}  // namespace visavis
