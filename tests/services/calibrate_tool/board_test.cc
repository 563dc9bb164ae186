#include "services/calibrate_tool/board.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/calibrate_tool/charuco.h"
#include "tests/support/config_refusal.h"

namespace visavis {
namespace {

BoardSpec Spec(const std::string& kind, int columns, int rows) {
  BoardSpec spec;
  spec.kind = kind;
  spec.columns = columns;
  spec.rows = rows;
  spec.square_mm = 24;
  spec.marker_mm = 18;
  return spec;
}

double BlackArea(const Board& board) {
  double area = 0;
  for (const BoardRect& r : board.black()) area += r.width * r.height;
  return area;
}

bool IsBlack(const Board& board, double x, double y) {
  for (const BoardRect& r : board.black())
    if (x >= r.x && x < r.x + r.width && y >= r.y && y < r.y + r.height) return true;
  return false;
}

TEST(BoardTest, CornersAreThoseOfOpenCvsBoardWithItsIds) {
  for (const auto& [columns, rows] : {std::pair(11, 8), std::pair(7, 5), std::pair(6, 6)}) {
    const BoardSpec spec = Spec("charuco", columns, rows);
    const Board board(spec);
    const auto theirs = MakeCharuco(spec)->chessboardCorners;
    ASSERT_EQ(board.corners().size(), theirs.size());
    for (std::size_t i = 0; i < theirs.size(); ++i) {
      const Eigen::Vector3d corner(theirs[i].x, theirs[i].y, theirs[i].z);
      EXPECT_LT((board.corners()[i] - corner).norm(), 1e-7) << i;  // theirs are floats
    }
  }
}

// Round each corner two black squares meet, and two white ones.
TEST(BoardTest, SquaresAlternate) {
  for (const char* kind : {"charuco", "chessboard"}) {
    const Board board(Spec(kind, 8, 5));
    for (const Eigen::Vector3d& c : board.corners()) {
      const double d = 0.001;  // within the white rim of a marker
      EXPECT_EQ(IsBlack(board, c.x() - d, c.y() - d), IsBlack(board, c.x() + d, c.y() + d));
      EXPECT_EQ(IsBlack(board, c.x() - d, c.y() + d), IsBlack(board, c.x() + d, c.y() - d));
      EXPECT_NE(IsBlack(board, c.x() - d, c.y() - d), IsBlack(board, c.x() + d, c.y() - d));
    }
    EXPECT_TRUE(IsBlack(board, 0.001, 0.001));
  }
}

TEST(BoardTest, AChessboardIsHalfBlackAndACharucoHasMoreForItsMarkers) {
  const Board chessboard(Spec("chessboard", 8, 5)), charuco(Spec("charuco", 8, 5));
  const double half = 0.5 * 8 * 5 * 0.024 * 0.024;
  EXPECT_NEAR(BlackArea(chessboard), half, 1e-12);
  // A marker is black by its border of 20 of 36 cells at least, and never wholly.
  const double markers = BlackArea(charuco) - half;
  EXPECT_GT(markers, 20 * 20.0 / 36 * 0.018 * 0.018);
  EXPECT_LT(markers, 20 * 0.018 * 0.018);
}

TEST(BoardTest, NothingOverlaps) {
  const Board board(Spec("charuco", 5, 4));
  const auto& black = board.black();
  for (std::size_t i = 0; i < black.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double x = std::min(black[i].x + black[i].width, black[k].x + black[k].width) -
                       std::max(black[i].x, black[k].x);
      const double y = std::min(black[i].y + black[i].height, black[k].y + black[k].height) -
                       std::max(black[i].y, black[k].y);
      EXPECT_FALSE(x > 1e-8 && y > 1e-8) << i << " " << k;
    }
  }
}

TEST(BoardTest, BoardsThatCannotServeAreRefused) {
  ExpectRefusal([] { Board(Spec("chessboard", 8, 6)); }, "rows", "6", "upside down");
  ExpectRefusal([] { Board(Spec("charuco", 40, 30)); }, "columns", "40", "at most 500");
  BoardSpec spec;
  spec.marker_mm = spec.square_mm;
  ExpectRefusal([&] { Board{spec}; }, "marker_mm", "17", "0.3 to 0.9 of square_mm");
}

}  // namespace
}  // namespace visavis
