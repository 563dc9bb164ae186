#include "services/recogniser/refined/score_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr int kWidth = 48, kHeight = 32;

PackedScores TableAt(const ColorModel& model, const ImageView& rgb, int x, int y) {
  const std::uint8_t* p = rgb.row(y) + 3 * x;
  return model.table()[static_cast<std::size_t>(ColorModel::BinOf(p[0], p[1], p[2]))];
}

TEST(ScoreMapTest, EachPixelWithinTheBoxHasItsColoursScores) {
  Random random(1);
  const OwnedImage image = NoiseImage(kWidth, kHeight, &random);
  const ColorModel model;
  ScoreMap map(kWidth, kHeight);
  const PixelBox box{8, 4, 40, 29};
  map.Build(image.view, model, box);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1;
      EXPECT_EQ(map.At(static_cast<float>(x), static_cast<float>(y)),
                inside ? TableAt(model, image.view, x, y) : ScoreMap::kUnknown);
    }
  }
}

TEST(ScoreMapTest, ThePixelNearestCounts) {
  Random random(2);
  const OwnedImage image = NoiseImage(kWidth, kHeight, &random);
  const ColorModel model;
  ScoreMap map(kWidth, kHeight);
  map.Build(image.view, model, {0, 0, kWidth, kHeight});
  for (const float aside : {-0.49f, -0.2f, 0.3f, 0.49f}) {
    EXPECT_EQ(map.At(17 + aside, 9 - aside), TableAt(model, image.view, 17, 9));
  }
  EXPECT_EQ(map.At(17.51f, 9), TableAt(model, image.view, 18, 9));
}

TEST(ScoreMapTest, OutsideIsUnknownAndNeutral) {
  const ColorModel model;
  ScoreMap map(kWidth, kHeight);
  map.Build(FlatImage(kWidth, kHeight, 200, 150, 120).view, model, {0, 0, kWidth, kHeight});
  for (const auto& [u, v] : {std::pair(-0.6f, 5.f),
                             {47.6f, 5.f},
                             {5.f, -0.6f},
                             {5.f, 31.6f},
                             {1e9f, 5.f},
                             {-1e9f, -1e9f},
                             {NAN, 5.f},
                             {5.f, NAN}}) {
    const PackedScores s = map.At(u, v);
    EXPECT_FALSE(IsKnown(s)) << u << " " << v;
    EXPECT_EQ(HairScore(s), 0);
    EXPECT_EQ(SkinScore(s), 0);
    EXPECT_EQ(HeadScore(s), 0);
  }
  EXPECT_TRUE(IsKnown(map.At(-0.4f, -0.4f)));
  EXPECT_TRUE(IsKnown(map.At(47.4f, 31.4f)));
}

TEST(ScoreMapTest, ANewBoxMakesTheOldOneUnknown) {
  const ColorModel model;
  const OwnedImage image = FlatImage(kWidth, kHeight, 200, 150, 120);
  ScoreMap map(kWidth, kHeight);
  map.Build(image.view, model, {0, 0, 16, 16});
  EXPECT_TRUE(IsKnown(map.At(5, 5)));
  map.Build(image.view, model, {16, 16, 32, 32});
  EXPECT_FALSE(IsKnown(map.At(5, 5)));
  EXPECT_TRUE(IsKnown(map.At(20, 20)));
  EXPECT_EQ(map.box().x0, 16);
  EXPECT_EQ(map.box().y1, 32);
}

TEST(ScoreMapTest, AGrayPixelHasTheScoresOfTheColourOfEqualChannels) {
  Random random(3);
  const OwnedImage gray = GrayImage(NoiseImage(kWidth, kHeight, &random).view);
  const ColorModel model;
  ScoreMap map(kWidth, kHeight);
  const PixelBox box{8, 4, 40, 29};
  map.Build(gray.view, model, box);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool inside = x >= box.x0 && x < box.x1 && y >= box.y0 && y < box.y1;
      const int level = gray.view.row(y)[x], bin = ColorModel::BinOf(level, level, level);
      EXPECT_EQ(map.At(static_cast<float>(x), static_cast<float>(y)),
                inside ? model.table()[static_cast<std::size_t>(bin)] : ScoreMap::kUnknown);
    }
  }
}

TEST(ScoreMapTest, BgrGivesTheSameScoresAsRgb) {
  Random random(4);
  const OwnedImage rgb = NoiseImage(kWidth, kHeight, &random), bgr = BgrImage(rgb.view);
  const ColorModel model;
  const PixelBox whole{0, 0, kWidth, kHeight};
  ScoreMap from_rgb(kWidth, kHeight), from_bgr(kWidth, kHeight);
  from_rgb.Build(rgb.view, model, whole);
  from_bgr.Build(bgr.view, model, whole);
  for (float y = 0; y < kHeight; ++y) {
    for (float x = 0; x < kWidth; ++x) EXPECT_EQ(from_rgb.At(x, y), from_bgr.At(x, y));
  }
}

TEST(ScoreMapTest, APictureOfAnotherSizeOrABoxBeyondItIsRefused) {
  const ColorModel model;
  ScoreMap map(kWidth, kHeight);
  using ::testing::Throws;
  EXPECT_THAT(
      [&] {
        map.Build(FlatImage(kWidth + 1, kHeight, 1, 2, 3).view, model, {0, 0, 8, 8});
      },
      Throws<std::invalid_argument>());
  const OwnedImage image = FlatImage(kWidth, kHeight, 1, 2, 3);
  for (const PixelBox& box : {PixelBox{-1, 0, 8, 8}, PixelBox{0, -1, 8, 8},
                              PixelBox{0, 0, kWidth + 1, 8}, PixelBox{0, 0, 8, kHeight + 1}}) {
    EXPECT_THAT([&] { map.Build(image.view, model, box); }, Throws<std::invalid_argument>());
  }
}

}  // namespace
}  // namespace visavis
