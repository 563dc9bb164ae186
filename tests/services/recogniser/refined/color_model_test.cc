#include "services/recogniser/refined/color_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

struct Rgb {
  int r, g, b;
};
constexpr Rgb kWall{96, 140, 176}, kHair{52, 36, 28}, kSkin{214, 160, 132}, kCurtain{180, 40, 40};

int BinOf(const Rgb& c) { return ColorModel::BinOf(c.r, c.g, c.b); }

PackedScores ScoresOf(const ColorModel& model, const Rgb& c) {
  return model.table()[static_cast<std::size_t>(BinOf(c))];
}

/// A picture of wall, a tenth of it skin and a twentieth hair, with a little noise.
OwnedImage Room() {
  Random random(1);
  OwnedImage image = FlatImage(200, 100, 0, 0, 0);
  for (std::size_t i = 0; i < image.bytes.size(); i += 3) {
    const double u = random.Uniform();
    const Rgb& c = u < 0.1 ? kSkin : u < 0.15 ? kHair : kWall;
    const int noise = random.Index(9) - 4;
    image.bytes[i] = static_cast<std::uint8_t>(c.r + noise);
    image.bytes[i + 1] = static_cast<std::uint8_t>(c.g + noise);
    image.bytes[i + 2] = static_cast<std::uint8_t>(c.b + noise);
  }
  return image;
}

void LearnThe(const Rgb& skin, const Rgb& hair, const Rgb& around, int times, ColorModel* model) {
  const auto counts = std::make_unique<ColorModel::Counts>();
  for (int i = 0; i < times; ++i) {
    counts->Clear();
    counts->Add(kSkinColor, BinOf(skin), 300);
    counts->Add(kHairColor, BinOf(hair), 300);
    counts->Add(kSurroundings, BinOf(around), 300);
    for (int r = 0; r < 256; r += 16)  // some of each red, too
      counts->Add(kSurroundings, BinOf({r, kCurtain.g, kCurtain.b}), 10);
    model->Learn(counts.get());
  }
}

TEST(PackedScoresTest, BytesAreHairSkinAndHeadRoundZero) {
  const PackedScores s = 0xff8a9c70u;
  EXPECT_EQ(HairScore(s), 0x70 - 128);
  EXPECT_EQ(SkinScore(s), 0x9c - 128);
  EXPECT_EQ(HeadScore(s), 0x8a - 128);
  EXPECT_TRUE(IsKnown(s));
  EXPECT_FALSE(IsKnown(0x00808080u));
}

TEST(ColorModelTest, ABinIsSixteenLevelsOfEachColour) {
  EXPECT_EQ(ColorModel::BinOf(0, 0, 0), 0);
  EXPECT_EQ(ColorModel::BinOf(255, 255, 255), ColorModel::kBins - 1);
  EXPECT_EQ(ColorModel::BinOf(16, 0, 0), 256);
  EXPECT_EQ(ColorModel::BinOf(0, 16, 0), 16);
  EXPECT_EQ(ColorModel::BinOf(0, 0, 16), 1);
  EXPECT_EQ(ColorModel::BinOf(15, 31, 47), 18);
  EXPECT_EQ(ColorModel::BinOf(79, 40, 200), ColorModel::BinOf(64, 47, 207));
}

TEST(ColorModelTest, TheTableKnowsEveryColour) {
  const ColorModel model;
  ASSERT_EQ(model.table().size(), static_cast<std::size_t>(ColorModel::kBins));
  for (const PackedScores s : model.table()) EXPECT_TRUE(IsKnown(s));
}

TEST(ColorModelTest, ThePriorTakesSkinOfAnyToneForSkinAndNotBluesAndGreens) {
  const ColorModel model;
  for (const Rgb& c : {Rgb{240, 205, 180}, kSkin, Rgb{168, 120, 92}, Rgb{120, 80, 56}}) {
    EXPECT_GT(SkinScore(ScoresOf(model, c)), 20) << c.r;
  }
  for (const Rgb& c : {Rgb{40, 70, 200}, Rgb{60, 180, 60}, Rgb{150, 200, 230}, Rgb{220, 20, 200}}) {
    EXPECT_LT(SkinScore(ScoresOf(model, c)), 0) << c.r;
  }
  EXPECT_GT(HairScore(ScoresOf(model, kHair)), HairScore(ScoresOf(model, Rgb{240, 240, 250})));
}

TEST(ColorModelTest, WhatARoomIsFullOfTellsLittleOfAHead) {
  ColorModel usual, red;
  const OwnedImage skin_coloured = FlatImage(64, 64, kSkin.r, kSkin.g, kSkin.b);
  red.StartFrom(skin_coloured.view);
  EXPECT_GT(SkinScore(ScoresOf(usual, kSkin)), 30);
  EXPECT_LT(std::abs(SkinScore(ScoresOf(red, kSkin))), 20);
}

TEST(ColorModelTest, LearnedColoursScorePositiveAndTheSurroundingsNegative) {
  ColorModel model;
  model.StartFrom(Room().view);
  LearnThe(kSkin, kHair, kWall, 4, &model);
  EXPECT_GT(SkinScore(ScoresOf(model, kSkin)), 40);
  EXPECT_LT(HairScore(ScoresOf(model, kSkin)), SkinScore(ScoresOf(model, kSkin)) - 40);
  EXPECT_GT(HairScore(ScoresOf(model, kHair)), 40);
  EXPECT_LT(SkinScore(ScoresOf(model, kHair)), HairScore(ScoresOf(model, kHair)) - 40);
  EXPECT_GT(HeadScore(ScoresOf(model, kSkin)), 0);
  EXPECT_GT(HeadScore(ScoresOf(model, kHair)), 0);
  for (const int score : {SkinScore(ScoresOf(model, kWall)), HairScore(ScoresOf(model, kWall)),
                          HeadScore(ScoresOf(model, kWall))}) {
    EXPECT_LT(score, -15);
  }
}

TEST(ColorModelTest, UnusualColoursAreLearnedToo) {
  ColorModel model;
  model.StartFrom(Room().view);
  constexpr Rgb kGreenHair{60, 190, 70};
  EXPECT_LT(HairScore(ScoresOf(model, kGreenHair)), 20);
  LearnThe(kSkin, kGreenHair, kWall, 4, &model);
  EXPECT_GT(HairScore(ScoresOf(model, kGreenHair)), 40);
}

TEST(ColorModelTest, ALearnedColourSpreadsToItsNeighboursNotFar) {
  ColorModel model;
  model.StartFrom(Room().view);
  LearnThe(kCurtain, kHair, kWall, 4, &model);
  const int at = SkinScore(ScoresOf(model, kCurtain));
  const int beside = SkinScore(ScoresOf(model, {kCurtain.r - 16, kCurtain.g, kCurtain.b}));
  const int far = SkinScore(ScoresOf(model, {kCurtain.r - 80, kCurtain.g, kCurtain.b}));
  EXPECT_GT(at, beside);
  EXPECT_GT(beside, far + 20);
}

// Scores are kScorePerNat times the logarithm of a ratio of shares: twice as often in the
// surroundings lowers them by 20 ln 2.
TEST(ColorModelTest, AScoreIsTwentyTimesTheLogarithmOfTheRatio) {
  ColorModel model;
  model.StartFrom(Room().view);
  const auto counts = std::make_unique<ColorModel::Counts>();
  for (int i = 0; i < 200; ++i) {  // until the start is forgotten
    counts->Clear();
    for (const auto& [c, share] : {std::pair(kCurtain, 0.25f), {kSkin, 0.75f}})
      counts->Add(kSkinColor, BinOf(c), 400 * share);
    for (const auto& [c, share] : {std::pair(kCurtain, 0.5f), {kWall, 0.5f}})
      counts->Add(kSurroundings, BinOf(c), 400 * share);
    model.Learn(counts.get());
  }
  // A tenth of the prior stays for good, and it knows no such skin.
  EXPECT_NEAR(SkinScore(ScoresOf(model, kCurtain)), 20 * std::log(0.9 * 0.25 / 0.5), 1.5);
}

TEST(ColorModelTest, TheFirstObservationsCountMoreThanTheLater) {
  ColorModel model;
  model.StartFrom(Room().view);
  const auto score = [&] { return SkinScore(ScoresOf(model, kCurtain)); };
  const int start = score();
  LearnThe(kCurtain, kHair, kWall, 1, &model);
  const int once = score();
  LearnThe(kSkin, kHair, kWall, 20, &model);
  const int faded = score();
  LearnThe(kCurtain, kHair, kWall, 1, &model);
  const int again = score();
  EXPECT_GT(once, start + 40);
  EXPECT_LT(faded, once - 10);
  EXPECT_GT(again, faded);
  EXPECT_LT(again, once);
}

TEST(ColorModelTest, ClassesWithFewCountsAreLeftAlone) {
  ColorModel model, untouched;
  const auto counts = std::make_unique<ColorModel::Counts>();
  counts->Add(kSkinColor, BinOf(kCurtain), 19);
  model.Learn(counts.get());
  EXPECT_EQ(model.table(), untouched.table());
  counts->Clear();
  counts->Add(kSkinColor, BinOf(kCurtain), 21);
  model.Learn(counts.get());
  EXPECT_NE(model.table(), untouched.table());
}

TEST(ColorModelTest, ResetGivesThePriorBack) {
  ColorModel model, fresh;
  model.StartFrom(Room().view);
  LearnThe(kCurtain, kHair, kWall, 3, &model);
  EXPECT_NE(model.table(), fresh.table());
  model.Reset();
  EXPECT_EQ(model.table(), fresh.table());
  LearnThe(kCurtain, kHair, kWall, 1, &model);
  LearnThe(kCurtain, kHair, kWall, 1, &fresh);
  EXPECT_EQ(model.table(), fresh.table());
}

TEST(ColorModelTest, BgrIsRgbSwapped) {
  const OwnedImage rgb = Room(), bgr = BgrImage(rgb.view);
  ColorModel from_rgb, from_bgr;
  from_rgb.StartFrom(rgb.view);
  from_bgr.StartFrom(bgr.view);
  EXPECT_EQ(from_rgb.table(), from_bgr.table());
  EXPECT_NE(from_rgb.table(), ColorModel().table());
}

}  // namespace
}  // namespace visavis
