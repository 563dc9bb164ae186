#include "services/calibrate_tool/view_collector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using Verdict = ViewCollector::Verdict;

constexpr ImageSizes kSizes{640, 480, 640, 480};
constexpr double kSharp = 2;

/// All corners of the board as a flat grid: corner 0 at (x, y), squares of @p side px; @p growth
/// from left to right, as of a tilted board.
BoardView Grid(const Board& board, double x, double y, double side, double growth = 0) {
  BoardView view;
  for (int i = 0; i < static_cast<int>(board.corners().size()); ++i) {
    const int column = i % board.corner_columns(), row = i / board.corner_columns();
    const double scale = 1 + growth * column;
    view.ids.push_back(i);
    view.pixels.emplace_back(x + side * scale * column, y + side * scale * row);
  }
  return view;
}

class ViewCollectorTest : public ::testing::Test {
 protected:
  Verdict Offer(double t_s, double x, double y, double edge_px = kSharp, double side = 40,
                double growth = 0) {
    StereoView view;
    view.utime_us = static_cast<std::int64_t>(1e6 * t_s);
    view.right = Grid(board_, x, y, side, growth);
    view.left = Grid(board_, x + 20, y, side, growth);
    return collector_.Offer(view, edge_px);
  }
  const Board board_{BoardSpec{"charuco", 6, 5, 24, 18, "4x4"}};
  ViewCollector collector_{board_, CollectorSettings{}, kSizes};
};

TEST_F(ViewCollectorTest, AViewThatIsNewSharpAndStillIsKept) {
  EXPECT_EQ(Offer(0, 100, 100), Verdict::kKept);
  EXPECT_EQ(Offer(1, 200, 100), Verdict::kKept);
  EXPECT_EQ(collector_.views().size(), 2u);
  EXPECT_EQ(collector_.count(Verdict::kKept), 2);
}

TEST_F(ViewCollectorTest, BlurredViewsAreLeftOut) {
  EXPECT_EQ(Offer(0, 100, 100, 4.6), Verdict::kBlurred);
  EXPECT_EQ(Offer(1, 100, 100, std::nan("")), Verdict::kKept);  // unknown
}

TEST_F(ViewCollectorTest, MovingViewsAreLeftOutUntilTheyRest) {
  EXPECT_EQ(Offer(0, 100, 100), Verdict::kKept);
  EXPECT_EQ(Offer(0.033, 180, 100), Verdict::kMoving);
  EXPECT_EQ(Offer(0.066, 200, 100), Verdict::kMoving);
  EXPECT_EQ(Offer(0.100, 200.5, 100), Verdict::kKept);
}

TEST_F(ViewCollectorTest, WhereTheBoardWasNotSeenJustBeforeItMayMove) {
  collector_.Offer({0, {}, {}}, std::nan(""));
  EXPECT_EQ(Offer(0.033, 100, 100), Verdict::kMoving);
  EXPECT_EQ(Offer(0.066, 100, 100), Verdict::kKept);
}

TEST_F(ViewCollectorTest, AViewLikeOneBeforeTeachesNothing) {
  Offer(0, 100, 100);
  EXPECT_EQ(Offer(1, 130, 100), Verdict::kNothingNew);
  EXPECT_EQ(Offer(2, 141, 100), Verdict::kKept);
  EXPECT_EQ(Offer(3, 100, 101), Verdict::kNothingNew);
}

TEST_F(ViewCollectorTest, BothEyesMustSeeEnough) {
  StereoView view{0, Grid(board_, 100, 100, 40), Grid(board_, 100, 100, 40)};
  view.left.ids.resize(11);
  view.left.pixels.resize(11);
  EXPECT_EQ(collector_.Offer(view, kSharp), Verdict::kNoBoard);
}

TEST_F(ViewCollectorTest, ItIsCompleteWithEnoughViews) {
  CollectorSettings settings;
  settings.num_views = 2;
  ViewCollector collector(board_, settings, kSizes);
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(collector.complete());
    collector.Offer({1'000'000 * i, Grid(board_, 100.0 * i, 50, 40), Grid(board_, 50, 50, 40)},
                    kSharp);
  }
  EXPECT_TRUE(collector.complete());
}

TEST_F(ViewCollectorTest, TheGuideNamesTheEmptiestPlaceTiltAndDistance) {
  EXPECT_EQ(collector_.Guide(), "show the board to both cameras");
  for (int i = 0; i < 3; ++i) Offer(i, 10 + 60 * i, 10);
  EXPECT_THAT(collector_.Guide(), HasSubstr("right image: nothing yet at the left"));
  EXPECT_THAT(collector_.Guide(), HasSubstr("tilt the board more"));
  EXPECT_THAT(collector_.Guide(), HasSubstr("go nearer and farther"));
  double t_s = 10;
  for (const double side : {40.0, 80.0})
    for (const double x : {1.0, 160.0, 320.0, 440.0})
      for (const double y : {1.0, 130.0, 300.0}) Offer(t_s++, x, y, kSharp, side, 0.03);
  EXPECT_EQ(collector_.Guide(), "");
}

TEST(CoverageMapTest, CountsCornersByCellAndNamesTheEmptiestPlace) {
  CoverageMap map(640, 480);
  EXPECT_EQ(map.share(), 0);
  BoardView view;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      if (row < 2 && column > 5) continue;
      view.ids.push_back(0);
      view.pixels.emplace_back(80 * column + 40, 80 * row + 40);
    }
  }
  map.Add(view);
  EXPECT_NEAR(map.share(), 44.0 / 48, 1e-12);
  EXPECT_EQ(map.count(0, 0), 1);
  EXPECT_EQ(map.count(7, 0), 0);
  EXPECT_EQ(map.EmptiestPlace(), "upper right");
}

}  // namespace
}  // namespace visavis
