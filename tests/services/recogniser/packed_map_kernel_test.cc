#include "services/recogniser/packed_map_kernel.h"

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/core/random.h"
#include "services/recogniser/fitness_kernel.h"
#include "tests/support/naive_fitness.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

using Bytes = std::vector<std::uint8_t>;

PackRule RuleOf(const ColorRuleConfig& config, bool bgr) {
  return {static_cast<std::uint8_t>(config.hair_min_p),
          static_cast<std::uint8_t>(config.skin_min_value),
          static_cast<std::uint8_t>(config.skin_min_saturation), bgr};
}

std::uint32_t NaivePixel(int r, int g, int b, const ColorRuleConfig& config) {
  const auto p = static_cast<std::uint32_t>(NaiveBrightness(r, g, b));
  return (NaiveIsHair(r, g, b, config) ? 0xffu : 0u) |
         (NaiveIsSkin(r, g, b, config) ? 0xff00u : 0u) | p << 16 | p << 24;
}

// All red and blue in steps, green coarsely and at each edge of Eq. 26: H = 0 (g = b), H = 30
// (2 (g - b) = r - b), H = 60 (g = r), each with its neighbours.
Bytes ColorsWithEdges() {
  Bytes rgb;
  for (int r = 0; r < 256; ++r) {
    for (int b = r % 3; b < 256; b += 3) {
      std::vector<int> greens = {0, 60, 120, 180, 240, 255};
      for (const int edge : {b, (r + b) / 2, r}) {
        for (int g = edge - 1; g <= edge + 1; ++g) greens.push_back(std::clamp(g, 0, 255));
      }
      for (const int g : greens) {
        for (const int v : {r, g, b}) rgb.push_back(static_cast<std::uint8_t>(v));
      }
    }
  }
  return rgb;
}

std::vector<ColorRuleConfig> Rules() {
  ColorRuleConfig as_printed;  // Eqs. 26 and 27 without gates
  as_printed.hair_min_p = 220;
  as_printed.skin_min_value = as_printed.skin_min_saturation = 0;
  ColorRuleConfig gated;
  gated.hair_min_p = 180;
  gated.skin_min_value = 50;
  gated.skin_min_saturation = 40;
  ColorRuleConfig extreme;
  extreme.hair_min_p = extreme.skin_min_value = extreme.skin_min_saturation = 255;
  return {as_printed, gated, extreme};
}

class PackedMapKernelTest : public ::testing::Test {
 protected:
  ~PackedMapKernelTest() override { SelectSimdTarget("auto"); }
};

TEST_F(PackedMapKernelTest, Eq26And27EqualTheNaiveRulesForEveryEdgeOfEveryColor) {
  const Bytes rgb = ColorsWithEdges();
  const auto n = rgb.size() / 3;
  Bytes bgr = rgb;
  for (std::size_t i = 0; i < n; ++i) std::swap(bgr[3 * i], bgr[3 * i + 2]);
  std::vector<std::uint32_t> packed(n), expected(n);
  for (const ColorRuleConfig& config : Rules()) {
    for (std::size_t i = 0; i < n; ++i) {
      expected[i] = NaivePixel(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], config);
    }
    for (const std::string& target : ListSimdTargets()) {
      SelectSimdTarget(target.c_str());
      PackColorRow(rgb.data(), static_cast<int>(n), RuleOf(config, false), packed.data());
      const auto wrong = std::mismatch(packed.begin(), packed.end(), expected.begin()).first;
      const auto i = static_cast<std::size_t>(wrong - packed.begin());
      ASSERT_EQ(i, n) << target << ": " << int{rgb[3 * i]} << ' ' << int{rgb[3 * i + 1]} << ' '
                      << int{rgb[3 * i + 2]} << " gives " << std::hex << *wrong << " not "
                      << expected[i];
      PackColorRow(bgr.data(), static_cast<int>(n), RuleOf(config, true), packed.data());
      ASSERT_EQ(packed, expected) << target << " bgr";
    }
  }
}

TEST_F(PackedMapKernelTest, TheSweepHoldsSkinHairAndNeither) {
  const Bytes rgb = ColorsWithEdges();
  int skin = 0, hair = 0, neither = 0;
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    const std::uint32_t pixel = NaivePixel(rgb[i], rgb[i + 1], rgb[i + 2], Rules()[1]);
    ++(pixel & 0xff ? hair : pixel & 0xff00 ? skin : neither);
  }
  EXPECT_GT(skin, 10000);
  EXPECT_GT(hair, 10000);
  EXPECT_GT(neither, 10000);
}

TEST_F(PackedMapKernelTest, Eq26IsOpenAtBothEnds) {
  const auto is_skin = [](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    const std::uint8_t rgb[] = {r, g, b};
    std::uint32_t pixel = 0;
    PackColorRow(rgb, 1, RuleOf(Rules()[0], false), &pixel);
    return (pixel & 0xff00u) != 0;
  };
  EXPECT_FALSE(is_skin(200, 100, 100));  // H = 0
  EXPECT_TRUE(is_skin(200, 101, 100));
  EXPECT_TRUE(is_skin(200, 149, 100));
  EXPECT_FALSE(is_skin(200, 150, 100));  // H = 30
  EXPECT_FALSE(is_skin(200, 100, 101));  // H = 359.4
  EXPECT_FALSE(is_skin(100, 100, 100));  // no hue
  EXPECT_FALSE(is_skin(0, 0, 0));
}

TEST_F(PackedMapKernelTest, Eq27IsOpenAtItsThreshold) {
  ColorRuleConfig config = Rules()[0];
  const auto is_hair = [&](std::uint8_t gray) {
    const std::uint8_t rgb[] = {gray, gray, gray};
    std::uint32_t pixel = 0;
    PackColorRow(rgb, 1, RuleOf(config, false), &pixel);
    return (pixel & 0xffu) != 0;
  };
  EXPECT_TRUE(is_hair(34));   // p = 221
  EXPECT_FALSE(is_hair(35));  // p = 220
  config.hair_min_p = 255;
  EXPECT_FALSE(is_hair(0));
}

TEST_F(PackedMapKernelTest, GrayIsPTwiceWithoutColor) {
  Bytes gray(256);
  std::vector<std::uint32_t> packed(256);
  for (int v = 0; v < 256; ++v) gray[v] = static_cast<std::uint8_t>(v);
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    PackGrayRow(gray.data(), 256, packed.data());
    for (std::uint32_t v = 0; v < 256; ++v) {
      EXPECT_EQ(packed[v], (255 - v) << 16 | (255 - v) << 24) << target;
    }
  }
}

// Memory whose last byte is followed by a page that cannot be read.
class GuardedBytes {
 public:
  GuardedBytes() : page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    memory_ = static_cast<std::uint8_t*>(
        mmap(nullptr, 2 * page_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    if (memory_ == MAP_FAILED || mprotect(memory_ + page_, page_, PROT_NONE) != 0) {
      ADD_FAILURE() << "no guarded memory";
    }
  }
  ~GuardedBytes() { munmap(memory_, 2 * page_); }
  GuardedBytes(const GuardedBytes&) = delete;
  GuardedBytes& operator=(const GuardedBytes&) = delete;

  std::uint8_t* Last(std::size_t size) const { return memory_ + page_ - size; }

 private:
  std::size_t page_;
  std::uint8_t* memory_;
};

TEST_F(PackedMapKernelTest, AnyWidthReadsNothingBehindTheRowAndWritesNothingBesideItsPixels) {
  const GuardedBytes guarded;
  Random random(3);
  constexpr std::uint32_t kSentinel = 0xdeadbeef;
  const ColorRuleConfig config = Rules()[1];
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (int n = 0; n <= 70; ++n) {
      for (const int bytes : {1, 3}) {
        std::uint8_t* row = guarded.Last(static_cast<std::size_t>(bytes * n));
        for (int i = 0; i < bytes * n; ++i) row[i] = static_cast<std::uint8_t>(random.Index(256));
        std::vector<std::uint32_t> out(static_cast<std::size_t>(n + 2), kSentinel);
        if (bytes == 1) {
          PackGrayRow(row, n, out.data() + 1);
        } else {
          PackColorRow(row, n, RuleOf(config, false), out.data() + 1);
        }
        EXPECT_EQ(out.front(), kSentinel) << target << ' ' << n;
        EXPECT_EQ(out.back(), kSentinel) << target << ' ' << n;
        for (int i = 0; i < n; ++i) {
          const std::uint8_t* p = row + bytes * i;
          const std::uint32_t expected =
              bytes == 1 ? (255u - p[0]) * 0x01010000u : NaivePixel(p[0], p[1], p[2], config);
          ASSERT_EQ(out[i + 1], expected) << target << " pixel " << i << " of " << n;
        }
      }
    }
  }
}

}  // namespace
}  // namespace visavis
