#include "services/recogniser/refined/picture_kernel.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/core/random.h"
#include "services/recogniser/fitness_kernel.h"
#include "services/recogniser/refined/color_model.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

constexpr std::uint32_t kUntouched = 0xdeadbeef;

class PictureKernelTest : public ::testing::Test {
 protected:
  ~PictureKernelTest() override { SelectSimdTarget("auto"); }
  // Vectors of exactly the size: a sanitizer sees what is read beyond.
  std::vector<std::uint8_t> Pixels(int n) {
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * n));
    for (auto& byte : pixels) byte = static_cast<std::uint8_t>(random_.Index(256));
    return pixels;
  }
  Random random_{1};
};

TEST_F(PictureKernelTest, ScoresAreTheTablesAtAnyLength) {
  std::vector<std::uint32_t> table(ColorModel::kBins);
  for (auto& entry : table) entry = static_cast<std::uint32_t>(random_.Bits());
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (int n = 0; n < 70; ++n) {
      const auto pixels = Pixels(n);
      for (const bool bgr : {false, true}) {
        std::vector<std::uint32_t> scores(static_cast<std::size_t>(n + 1), kUntouched);
        LookUpScores(pixels.data(), n, bgr, table.data(), scores.data());
        for (int i = 0; i < n; ++i) {
          const std::uint8_t* p = pixels.data() + 3 * i;
          const int bin = ColorModel::BinOf(p[bgr ? 2 : 0], p[1], p[bgr ? 0 : 2]);
          ASSERT_EQ(scores[static_cast<std::size_t>(i)], table[static_cast<std::size_t>(bin)])
              << target << " " << n;
        }
        EXPECT_EQ(scores.back(), kUntouched);
      }
    }
  }
}

TEST_F(PictureKernelTest, BrightnessIsTheMeanOfTwoRowsAtAnyLength) {
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (int n = 0; n < 70; ++n) {
      const auto top = Pixels(n), bottom = Pixels(n);
      for (const bool bgr : {false, true}) {
        std::vector<std::uint16_t> means(static_cast<std::size_t>(n + 1), 4711);
        MeanBrightness(top.data(), bottom.data(), n, bgr, means.data());
        for (int i = 0; i < n; ++i) {
          const auto brightness = [&](const std::vector<std::uint8_t>& row) {
            const std::uint8_t* p = row.data() + 3 * i;
            return 77 * p[bgr ? 2 : 0] + 150 * p[1] + 29 * p[bgr ? 0 : 2];
          };
          ASSERT_EQ(means[static_cast<std::size_t>(i)],
                    (brightness(top) + brightness(bottom) + 1) / 2)
              << target << " " << n;
        }
        EXPECT_EQ(means.back(), 4711);
      }
    }
  }
}

TEST_F(PictureKernelTest, BrightnessHoldsTheBrightestPicture) {
  const std::vector<std::uint8_t> white(3 * 64, 255);
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    std::vector<std::uint16_t> means(64);
    MeanBrightness(white.data(), white.data(), 64, false, means.data());
    for (const std::uint16_t mean : means) EXPECT_EQ(mean, 255 * 256);
  }
}

}  // namespace
}  // namespace visavis
