#include "services/calibrate_tool/board_detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/board_pictures.h"

namespace visavis {
namespace {

BoardSpec Spec(const std::string& kind) {
  BoardSpec spec;
  spec.kind = kind;
  spec.columns = 8;
  spec.rows = 7;
  spec.square_mm = 40;
  spec.marker_mm = 30;
  return spec;
}

/// Pictures of a board and what is found in them.
class BoardDetectorTest : public ::testing::TestWithParam<const char*> {
 protected:
  BoardView See(const RigidTransform& X_KT, double motion_px = 0) {
    grey_ = renderer_.Render(X_KT, 2, &random_, motion_px);
    return detector_.Detect({grey_.data(), camera_.width, camera_.height, camera_.width,
                             grey_.size(), PixelFormat::kGray});
  }
  /// Board about @p distance_m away, turned by @p r.
  RigidTransform Place(double distance_m, const Eigen::Vector3d& r) const {
    const Eigen::Matrix3d R = ExpRotation(r);
    return MakeTransform(
        R, Eigen::Vector3d(0, 0, distance_m) -
               R * Eigen::Vector3d(0.5 * board_.width_m(), 0.5 * board_.height_m(), 0));
  }
  /// Root mean square distance of the corners from where they are [px].
  double Error(const RigidTransform& X_KT, const BoardView& view) const {
    double sum = 0;
    for (std::size_t i = 0; i < view.ids.size(); ++i) {
      const Eigen::Vector3d& p = board_.corners()[static_cast<std::size_t>(view.ids[i])];
      sum += (Project(camera_, X_KT * p).uv - view.pixels[i]).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(view.ids.size()));
  }
  const Board board_{Spec(GetParam())};
  const Pinhole camera_ = SkewedRig().right;
  const BoardRenderer renderer_{board_, camera_};
  BoardDetector detector_{board_};
  Random random_{1};
  std::vector<std::uint8_t> grey_;
};

TEST_P(BoardDetectorTest, CornersAreFoundToATenthOfAPixelFromAllSides) {
  for (const Eigen::Vector3d& r : {Eigen::Vector3d(0.02, 0.01, 0), Eigen::Vector3d(0.5, 0.2, 0.1),
                                   Eigen::Vector3d(-0.4, 0.5, -0.3), Eigen::Vector3d(0.1, 0, 2.9),
                                   Eigen::Vector3d(0.2, -0.3, 1.5)}) {
    const RigidTransform X_KT = Place(0.75, r);
    const BoardView view = See(X_KT);
    ASSERT_GT(view.ids.size(), 38u) << r.transpose();
    EXPECT_LT(Error(X_KT, view), 0.12) << r.transpose();
  }
}

TEST_P(BoardDetectorTest, EdgesTellSharpPicturesFromMovedOnes) {
  const RigidTransform X_KT = Place(0.75, {0.2, 0.1, 0.05});
  const double sharp = detector_.EdgeWidth(See(X_KT));
  EXPECT_GT(sharp, 1);
  EXPECT_LT(sharp, 2.5);
  const double moved = detector_.EdgeWidth(See(Place(0.75, {0.2, 0.1, 0.8}), 6));
  EXPECT_GT(moved, 4.5);
}

TEST_P(BoardDetectorTest, WhereThereIsNoBoardNothingIsFound) {
  const RigidTransform behind = Place(-2, {0, 0, 0});
  const BoardView view = See(behind);
  EXPECT_TRUE(view.ids.empty());
  EXPECT_TRUE(std::isnan(detector_.EdgeWidth(view)));
}

INSTANTIATE_TEST_SUITE_P(Kinds, BoardDetectorTest, ::testing::Values("charuco", "chessboard"));

TEST(CharucoDetectorTest, ABoardPartlyOutsideThePictureIsFoundInPart) {
  const Board board(Spec("charuco"));
  const Pinhole camera = SkewedRig().right;
  const BoardRenderer renderer(board, camera);
  BoardDetector detector(board);
  Random random(2);
  const RigidTransform X_KT = MakeTransform(ExpRotation({0, 0, 0}), Eigen::Vector3d(0, -0.1, 0.6));
  const auto grey = renderer.Render(X_KT, 2, &random);
  const BoardView view = detector.Detect(
      {grey.data(), camera.width, camera.height, camera.width, grey.size(), PixelFormat::kGray});
  EXPECT_GT(view.ids.size(), 8u);
  EXPECT_LT(view.ids.size(), board.corners().size());
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector3d& p = board.corners()[static_cast<std::size_t>(view.ids[i])];
    EXPECT_LT((Project(camera, X_KT * p).uv - view.pixels[i]).norm(), 0.5);
  }
}

TEST(CharucoDetectorTest, ColouredPicturesServeToo) {
  const Board board(Spec("charuco"));
  const Pinhole camera = SkewedRig().right;
  BoardDetector detector(board);
  Random random(3);
  const Eigen::Matrix3d R = ExpRotation({0.1, 0, 0});
  const auto grey = BoardRenderer(board, camera)
                        .Render(MakeTransform(R, Eigen::Vector3d(-0.16, -0.14, 0.75)), 2, &random);
  std::vector<std::uint8_t> rgb;
  for (const std::uint8_t value : grey) rgb.insert(rgb.end(), 3, value);
  for (const PixelFormat format : {PixelFormat::kRgb, PixelFormat::kBgr}) {
    EXPECT_EQ(
        detector
            .Detect({rgb.data(), camera.width, camera.height, 3 * camera.width, rgb.size(), format})
            .ids.size(),
        board.corners().size());
  }
}

}  // namespace
}  // namespace visavis
