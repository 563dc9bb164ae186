#include "services/recogniser/packed_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "common/config/config_reader.h"
#include "common/core/random.h"
#include "services/recogniser/fitness_kernel.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/naive_fitness.h"
#include "tests/support/simd_targets.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

ColorRuleConfig ARule() {
  ColorRuleConfig rule;
  rule.hair_min_p = 200;
  rule.skin_min_value = 40;
  rule.skin_min_saturation = 30;
  return rule;
}

void ExpectBorderIsZero(const PackedMap& map) {
  for (int x = -1; x <= map.width(); ++x) {
    EXPECT_EQ(map.at(x, -1), 0u) << x;
    EXPECT_EQ(map.at(x, map.height()), 0u) << x;
  }
  for (int y = -1; y <= map.height(); ++y) {
    EXPECT_EQ(map.at(-1, y), 0u) << y;
    EXPECT_EQ(map.at(map.width(), y), 0u) << y;
  }
}

TEST(PackedMapTest, HoldsBHAndPOfEachPixel) {
  Random random(1);
  const OwnedImage image = NoiseImage(37, 11, &random);
  PackedMap map(37, 11);
  map.Build(image.view, ARule());
  for (int y = 0; y < 11; ++y) {
    for (int x = 0; x < 37; ++x) {
      const std::uint8_t* c = image.view.row(y) + 3 * x;
      const std::uint32_t pixel = map.at(x, y);
      EXPECT_EQ(pixel & 255, NaiveIsHair(c[0], c[1], c[2], ARule()) ? 255u : 0u);
      EXPECT_EQ(pixel >> 8 & 255, NaiveIsSkin(c[0], c[1], c[2], ARule()) ? 255u : 0u);
      EXPECT_EQ(pixel >> 16 & 255, static_cast<unsigned>(NaiveBrightness(c[0], c[1], c[2])));
      EXPECT_EQ(pixel >> 24, pixel >> 16 & 255);
    }
  }
  EXPECT_TRUE(map.has_color());
}

TEST(PackedMapTest, TheBorderStaysZeroAtAnySizeAndFormat) {
  Random random(2);
  for (int width = 1; width < 40; width += 3) {
    for (int height = 1; height < 6; height += 2) {
      const OwnedImage rgb = NoiseImage(width, height, &random);
      const OwnedImage gray = GrayImage(rgb.view), bgr = BgrImage(rgb.view);
      PackedMap map(width, height);
      ExpectBorderIsZero(map);
      for (const ImageView& view : {rgb.view, gray.view, bgr.view}) {
        map.Build(view, ARule());
        ExpectBorderIsZero(map);
        EXPECT_NE(map.at(width / 2, height / 2), 0u);
      }
    }
  }
}

bool SamePixels(const PackedMap& a, const PackedMap& b) {
  for (int y = -1; y <= a.height(); ++y) {
    for (int x = -1; x <= a.width(); ++x) {
      if (a.at(x, y) != b.at(x, y)) return false;
    }
  }
  return true;
}

TEST(PackedMapTest, BgrGivesTheSameMapAsRgb) {
  Random random(3);
  const OwnedImage rgb = NoiseImage(61, 7, &random), bgr = BgrImage(rgb.view);
  PackedMap from_rgb(61, 7), from_bgr(61, 7);
  from_rgb.Build(rgb.view, ARule());
  from_bgr.Build(bgr.view, ARule());
  EXPECT_TRUE(SamePixels(from_rgb, from_bgr));
}

TEST(PackedMapTest, AGrayPictureHasBrightnessAlone) {
  Random random(4);
  const OwnedImage rgb = NoiseImage(33, 5, &random), gray = GrayImage(rgb.view);
  PackedMap from_rgb(33, 5), from_gray(33, 5);
  from_rgb.Build(rgb.view, ARule());
  from_gray.Build(gray.view, ARule());
  EXPECT_FALSE(from_gray.has_color());
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 33; ++x) EXPECT_EQ(from_gray.at(x, y), from_rgb.at(x, y) & 0xffff0000u);
  }
}

TEST(PackedMapTest, PaddingOfTheImagesRowsIsSkipped) {
  Random random(5);
  const OwnedImage image = NoiseImage(23, 9, &random);
  std::vector<std::uint8_t> padded(9 * 80, 77);
  for (int y = 0; y < 9; ++y) std::copy_n(image.view.row(y), 69, padded.begin() + 80 * y);
  PackedMap expected(23, 9), map(23, 9);
  expected.Build(image.view, ARule());
  map.Build({padded.data(), 23, 9, 80, padded.size(), PixelFormat::kRgb}, ARule());
  EXPECT_TRUE(SamePixels(map, expected));
}

TEST(PackedMapTest, EverySimdTargetGivesTheSameMap) {
  Random random(6);
  const OwnedImage image = NoiseImage(101, 13, &random);
  PackedMap expected(101, 13);
  expected.Build(image.view, ARule());
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    PackedMap map(101, 13);
    map.Build(image.view, ARule());
    EXPECT_TRUE(SamePixels(map, expected)) << target;
  }
  SelectSimdTarget("auto");
}

TEST(PackedMapTest, ClearLeavesNothing) {
  Random random(7);
  PackedMap map(8, 8), empty(8, 8);
  map.Build(NoiseImage(8, 8, &random).view, ARule());
  EXPECT_FALSE(SamePixels(map, empty));
  map.Clear();
  EXPECT_TRUE(SamePixels(map, empty));
}

TEST(PackedMapTest, BuildingAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  Random random(8);
  const OwnedImage rgb = NoiseImage(64, 48, &random), gray = GrayImage(rgb.view);
  const ColorRuleConfig rule = ARule();
  PackedMap map(64, 48);
  map.Build(rgb.view, rule);
  const std::int64_t before = NumMallocs();
  map.Build(rgb.view, rule);
  map.Build(gray.view, rule);
  EXPECT_EQ(NumMallocs(), before);
}

TEST(PackedMapTest, AnImageOfAnotherSizeOrOfNoPixelsIsRefused) {
  Random random(9);
  PackedMap map(16, 8);
  using ::testing::Throws;
  EXPECT_THAT([&] { map.Build(NoiseImage(17, 8, &random).view, ARule()); },
              Throws<std::invalid_argument>());
  EXPECT_THAT([&] { map.Build(NoiseImage(16, 9, &random).view, ARule()); },
              Throws<std::invalid_argument>());
  ImageView bayer = NoiseImage(16, 8, &random).view;
  bayer.format = PixelFormat::kBayerRggb;
  EXPECT_THAT([&] { map.Build(bayer, ARule()); }, Throws<std::invalid_argument>());
  for (const auto& [width, height] : {std::pair(0, 4), std::pair(4, 0), std::pair(20000, 4),
                                      std::pair(4, 20000), std::pair(-1, 4)}) {
    EXPECT_THAT([&] { PackedMap bad(width, height); }, Throws<std::invalid_argument>());
  }
}

struct ColorFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("color", &color);
  }
  void ValidateOrThrow() const {}
  ColorRuleConfig color;
};

TEST(ColorRuleConfigTest, EveryThresholdIsAByte) {
  for (const std::string key : {"hair_min_p", "skin_min_value", "skin_min_saturation"}) {
    for (const std::string value : {"-1", "256", "1.5"}) {
      EXPECT_THAT([&] { LoadConfig<ColorFile>("", {"color." + key + "=" + value}); },
                  ::testing::ThrowsMessage<ConfigError>(::testing::AllOf(
                      ::testing::HasSubstr("color." + key), ::testing::HasSubstr(value),
                      ::testing::HasSubstr("must be"))));
    }
    EXPECT_NO_THROW(LoadConfig<ColorFile>("", {"color." + key + "=255"}));
  }
}

}  // namespace
}  // namespace visavis
