#include "services/calibrate_tool/pair_intake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/convert/message_error.h"
#include "tests/support/board_pictures.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using Verdict = ViewCollector::Verdict;

TEST(PairIntakeTest, RenderedPairsAreJudgedByWhatTheyShow) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 2, 1);
  const PairRenderer renderer(scene);
  Random random(1);
  PairIntake intake(scene.board, CollectorSettings{});
  EXPECT_FALSE(intake.collector().has_value());
  EXPECT_EQ(intake.Summary(), "no stereo pair");
  EXPECT_EQ(intake.Add(renderer.Render(scene.X_CT[0], 0, &random)), Verdict::kKept);
  EXPECT_EQ(intake.sizes().left_width, 640);
  EXPECT_EQ(intake.Add(renderer.Render(scene.X_CT[0], 1'000'000, &random)), Verdict::kNothingNew);
  EXPECT_EQ(intake.Add(renderer.Render(scene.X_CT[1], 2'000'000, &random, 8)), Verdict::kBlurred);
  const RigidTransform behind =
      MakeTransform(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(0, 0, -1));
  EXPECT_EQ(intake.Add(renderer.Render(behind, 3'000'000, &random)), Verdict::kNoBoard);
  EXPECT_EQ(intake.num_pairs(), 4);
  EXPECT_EQ(intake.Summary(),
            "1 views kept of 4 pairs: 1 without enough of the board in both images, 1 blurred, "
            "1 like one before");
}

TEST(PairIntakeTest, EyesAreFoundByTypeAndNotByOrder) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 1, 1);
  Random random(1);
  images_t pair = PairRenderer(scene).Render(scene.X_CT[0], 0, &random);
  std::swap(pair.images[0], pair.images[1]);
  std::swap(pair.image_types[0], pair.image_types[1]);
  PairIntake intake(scene.board, CollectorSettings{});
  ASSERT_EQ(intake.Add(pair), Verdict::kKept);
  const BoardView& right = intake.collector()->views()[0].right;
  const Eigen::Vector3d& p = scene.board.corners()[static_cast<std::size_t>(right.ids[0])];
  EXPECT_LT((Project(scene.rig.right, scene.X_CT[0] * p).uv - right.pixels[0]).norm(), 0.5);
}

TEST(PairIntakeTest, PairsWithOneEyeOrAnotherSizeAreRefused) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 1, 3);
  Random random(1);
  const images_t pair = PairRenderer(scene).Render(scene.X_CT[0], 0, &random);
  PairIntake intake(scene.board, CollectorSettings{});
  images_t one = pair;
  one.image_types[0] = images_t::RIGHT;
  EXPECT_THAT([&] { intake.Add(one); },
              ThrowsMessage<MessageError>(HasSubstr("must name a left and a right image")));
  intake.Add(pair);
  images_t smaller = pair;
  smaller.images[1].height = 240;
  EXPECT_THAT([&] { intake.Add(smaller); },
              ThrowsMessage<MessageError>(
                  HasSubstr("images_t.images[right]: 640x240: must have the size of the first")));
}

}  // namespace
}  // namespace visavis
