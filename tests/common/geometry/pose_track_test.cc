#include "common/geometry/pose_track.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

RigidTransform At(double x_m, double angle_rad) {
  return MakeTransform(ExpRotation({0, 0, angle_rad}), Eigen::Vector3d(x_m, 0, 0));
}

TEST(PoseTrackTest, SortsAndKeepsTheLastOfEqualTimes) {
  const PoseTrack track({{300, At(3, 0)}, {100, At(1, 0)}, {300, At(4, 0)}, {200, At(2, 0)}});
  ASSERT_EQ(track.poses().size(), 3u);
  EXPECT_EQ(track.poses()[0].utime_us, 100);
  EXPECT_EQ(track.poses()[1].utime_us, 200);
  ASSERT_NE(track.Find(300), nullptr);
  EXPECT_EQ(track.Find(300)->translation().x(), 4);
  EXPECT_EQ(track.Find(250), nullptr);
  EXPECT_EQ(track.Find(301), nullptr);
}

TEST(PoseTrackTest, InterpolatesBetweenNeighboursThatAreCloseEnough) {
  const PoseTrack track({{100, At(1, 0.1)}, {200, At(2, 0.3)}});
  const auto X = track.At(125, 100);
  ASSERT_TRUE(X);
  EXPECT_LT((X->matrix() - At(1.25, 0.15).matrix()).norm(), 1e-12);
  EXPECT_FALSE(track.At(125, 99));
}

TEST(PoseTrackTest, NeverExtrapolates) {
  const PoseTrack track({{100, At(1, 0)}, {200, At(2, 0)}});
  EXPECT_TRUE(track.At(100, 0));
  EXPECT_TRUE(track.At(200, 0));
  EXPECT_FALSE(track.At(99, 1000));
  EXPECT_FALSE(track.At(201, 1000));
  EXPECT_FALSE(PoseTrack().At(0, 1000));
}

}  // namespace
}  // namespace visavis
