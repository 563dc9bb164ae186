#include "services/simulator/texture.h"

#include <gtest/gtest.h>

#include "services/simulator/bake.h"

namespace visavis {
namespace {

/// Red rises by 16 a column, green by 32 a row.
Texture Ramp() {
  Texture texture(8, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      texture.at(x, y).red = static_cast<std::uint8_t>(16 * x);
      texture.at(x, y).green = static_cast<std::uint8_t>(32 * y);
      texture.at(x, y).label = x < 4 ? Label::kSkin : Label::kHair;
    }
  }
  texture.BuildLevels();
  return texture;
}

Texel Sample(const Texture& texture, float u, float v, int level) {
  return Texture::Fetch(texture.Locate(u, v, level));
}

TEST(TextureTest, ReturnsATexelAtItsCentre) {
  const Texture texture = Ramp();
  const Texel texel = Sample(texture, 5.5f / 8, 2.5f / 4, 0);
  EXPECT_EQ(texel.red, 80);
  EXPECT_EQ(texel.green, 64);
  EXPECT_EQ(texel.label, Label::kHair);
}

TEST(TextureTest, MixesLinearlyBetweenCentres) {
  const Texture texture = Ramp();
  for (int i = 0; i <= 16; ++i) {
    const float x = 1.5f + static_cast<float>(i) / 4;
    const double expected = 16 * (static_cast<double>(x) - 0.5);
    EXPECT_NEAR(Sample(texture, x / 8, 0.5f, 0).red, expected, 1.01) << x;
  }
}

TEST(TextureTest, RepeatsItsEdges) {
  const Texture texture = Ramp();
  EXPECT_EQ(Sample(texture, 0, 0, 0).red, 0);
  EXPECT_EQ(Sample(texture, 1, 1, 0).red, 112);
  EXPECT_EQ(Sample(texture, -3, 7, 0).green, 96);
}

TEST(TextureTest, CoarserLevelsAverageColoursAndVoteOnLabels) {
  const Texture texture = Ramp();
  EXPECT_EQ(texture.num_levels(), 4);
  const Texel texel = Sample(texture, 0.5f / 4, 0.5f / 2, 1);
  EXPECT_EQ(texel.red, 8);
  EXPECT_EQ(texel.green, 16);
  EXPECT_EQ(texel.label, Label::kSkin);
  EXPECT_EQ(Sample(texture, 0.5f, 0.5f, 99).red, 56);  // the last level: one texel
}

TEST(TextureTest, RefusesSizesThatAreNoPowersOfTwo) {
  EXPECT_THROW(Texture(3, 4), std::invalid_argument);
  EXPECT_THROW(Texture(4, 0), std::invalid_argument);
}

TEST(BakeTest, ReliefTiltsTheNormalAgainstItsSlope) {
  // A plane seen from -z; relief rises by 0.5 mm a mm along x: the outward normal leans to -x.
  const PaintedSurface surface{
      [](double u, double v) { return Eigen::Vector3d(10 * u, 10 * v, 0); },
      [](double u, double) {
        Paint paint;
        paint.height_mm = 5 * u;
        return paint;
      }};
  const Texture texture = BakeTexture(surface, 16, 16);
  EXPECT_NEAR(texture.at(8, 8).dx - 128, -0.5 * 64, 1);
  EXPECT_EQ(texture.at(8, 8).dy, 128);
  EXPECT_EQ(texture.at(8, 8).dz, 128);
}

TEST(BakeTest, UniformTextureKeepsColourAndLabel) {
  const Texture texture = UniformTexture(Srgb(1, 0, 0.5), 0.25, Label::kEye);
  const Texel texel = Sample(texture, 0.3f, 0.8f, 0);
  EXPECT_EQ(texel.red, 255);
  EXPECT_EQ(texel.green, 0);
  EXPECT_NEAR(texel.blue, 255 * std::sqrt(LinearFromSrgb(0.5)), 1);
  EXPECT_EQ(texel.gloss, 64);
  EXPECT_EQ(texel.label, Label::kEye);
}

}  // namespace
}  // namespace visavis
