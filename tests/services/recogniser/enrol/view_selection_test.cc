#include "services/recogniser/enrol/view_selection.h"

#include <gtest/gtest.h>

#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr int kSettled = 5;

/// A head 1 m ahead whose face looks @p right [rad] to the image's right and @p down [rad].
RigidTransform Facing(double right, double down) {
  return MakeTransform(ExpRotation({0, -right, 0}) * ExpRotation({down, 0, 0}), Vector3d(0, 0, 1));
}

/// Shows @p frames frames of @p X_CM, numbered from @p first.
void Show(ViewSelection* selection, const RigidTransform& X_CM, int first, int frames = kSettled) {
  for (int i = 0; i < frames; ++i) selection->Add(first + i, &X_CM);
}

TEST(ViewSelectionTest, TheFacingOfTheseTestsIsThatOfTheImage) {
  const Vector3d face = Facing(0.3, 0.2).linear() * Vector3d(0, 0, -1);
  EXPECT_GT(face.x(), 0.2);
  EXPECT_GT(face.y(), 0.15);
  EXPECT_LT(face.z(), -0.9);
}

TEST(ViewSelectionTest, AViewIsTakenOnceTheTrackHasSettled) {
  ViewSelection selection;
  Show(&selection, Facing(0, 0), 0, kSettled - 1);
  EXPECT_TRUE(selection.Views(60).empty());
  Show(&selection, Facing(0, 0), kSettled - 1, 1);
  ASSERT_EQ(selection.Views(60).size(), 1u);
  EXPECT_EQ(selection.Views(60)[0].frame, kSettled - 1);
  EXPECT_EQ(selection.Views(60)[0].X_CM.matrix(), Facing(0, 0).matrix());
}

TEST(ViewSelectionTest, ALostFrameUnsettlesTheTrack) {
  ViewSelection selection;
  for (int round = 0; round < 5; ++round) {
    Show(&selection, Facing(0, 0), 10 * round, kSettled - 1);
    selection.Add(10 * round + 9, nullptr);
  }
  EXPECT_TRUE(selection.Views(60).empty());
}

TEST(ViewSelectionTest, EachDirectionIsTakenOnceWhereverTheHeadIs) {
  ViewSelection selection;
  Show(&selection, Facing(0, 0), 0);
  Show(&selection, Facing(0.04, 0), 10);  // nearly the same
  RigidTransform nearer = Facing(0, 0), rolled = Facing(0, 0);
  nearer.translation().z() = 0.7;
  rolled.linear() = ExpRotation({0, 0, 0.5}) * rolled.linear();
  Show(&selection, nearer, 20);
  Show(&selection, rolled, 30);
  EXPECT_EQ(selection.Views(60).size(), 1u);
  Show(&selection, Facing(0.06, 0), 40);
  Show(&selection, Facing(0, -0.06), 50);
  RigidTransform aside = Facing(0, 0);  // seen from its side, though not turned
  aside.translation().x() = 0.2;
  Show(&selection, aside, 60);
  EXPECT_EQ(selection.Views(60).size(), 4u);
}

TEST(ViewSelectionTest, AtMostSoManyViewsComeEvenlyFromAll) {
  ViewSelection selection;
  for (int i = 0; i < 12; ++i) Show(&selection, Facing(0.06 * i, 0), 10 * i);
  EXPECT_EQ(selection.Views(12).size(), 12u);
  EXPECT_EQ(selection.Views(100).size(), 12u);
  const auto some = selection.Views(4);
  ASSERT_EQ(some.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_TRUE(some[static_cast<std::size_t>(i)].X_CM.isApprox(Facing(0.18 * i, 0))) << i;
  }
}

TEST(ViewSelectionTest, TheRangeTellsHowFarTheFaceTurnedRightAndDown) {
  ViewSelection selection;
  int frame = 0;
  for (const auto& [right, down] :
       {std::pair(0.5, 0.0), {-0.2, 0.0}, {0.0, 0.4}, {0.0, -0.1}, {0.1, 0.1}}) {
    Show(&selection, Facing(right, down), frame += 10);
  }
  const ViewSelection::Range range = selection.DirectionRange();
  EXPECT_NEAR(range.max_yaw, 0.5, 1e-9);
  EXPECT_NEAR(range.min_yaw, -0.2, 1e-9);
  EXPECT_NEAR(range.max_pitch, 0.4, 1e-9);
  EXPECT_NEAR(range.min_pitch, -0.1, 1e-9);
}

}  // namespace
}  // namespace visavis
