#include <gtest/gtest.h>

#include "services/recogniser/genetic_algorithm.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

SearchSpace ASpace() {
  return {PhiOf(-150, -90, 800, -20, -25, -30), PhiOf(210, 110, 1300, 30, 25, 20)};
}

class GeneCodecTest : public ::testing::TestWithParam<int> {
 protected:
  const int bits_ = GetParam();
  const GeneCodec codec_{ASpace(), bits_};
};
INSTANTIATE_TEST_SUITE_P(Bits, GeneCodecTest, ::testing::Values(4, 8, 10));

TEST_P(GeneCodecTest, EveryGeneDecodesAndEncodesToItself) {
  Random random(1);
  EXPECT_EQ(codec_.num_bits(), 6 * bits_);
  for (int i = 0; i < 2000; ++i) {
    const std::uint64_t gene = random.Bits() >> (64 - codec_.num_bits());
    EXPECT_EQ(codec_.Encode(codec_.Decode(gene)), gene);
  }
}

TEST_P(GeneCodecTest, TheSpacesCornersAreTheFirstAndTheLastGene) {
  const std::uint64_t last = (std::uint64_t{1} << codec_.num_bits()) - 1;
  EXPECT_EQ(codec_.Encode(ASpace().min), 0u);
  EXPECT_EQ(codec_.Encode(ASpace().max), last);
  EXPECT_TRUE(codec_.Decode(0).isApprox(ASpace().min));
  EXPECT_TRUE(codec_.Decode(last).isApprox(ASpace().max));
}

TEST_P(GeneCodecTest, OneLevelOfAParameterIsOneStepOfItAlone) {
  for (int k = 0; k < 6; ++k) {
    EXPECT_DOUBLE_EQ(codec_.step()[k], ASpace().range()[k] / ((1 << bits_) - 1));
    Vector6d expected = ASpace().min;
    expected[k] += codec_.step()[k];
    EXPECT_TRUE(codec_.Decode(std::uint64_t{1} << (bits_ * k)).isApprox(expected)) << k;
  }
}

TEST_P(GeneCodecTest, EncodesToTheNearestLevel) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    Vector6d phi;
    for (int k = 0; k < 6; ++k) phi[k] = random.Uniform(ASpace().min[k], ASpace().max[k]);
    const Vector6d off = (codec_.Decode(codec_.Encode(phi)) - phi).cwiseQuotient(codec_.step());
    EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.5 + 1e-9);
  }
}

TEST_P(GeneCodecTest, WhatLiesOutsideCountsAsTheBorder) {
  for (int k = 0; k < 6; ++k) {
    Vector6d below = PhiOf(0, 0, 1000, 0, 0, 0), above = below;
    below[k] = -50;
    above[k] = 50;
    EXPECT_DOUBLE_EQ(codec_.Decode(codec_.Encode(below))[k], ASpace().min[k]);
    EXPECT_NEAR(codec_.Decode(codec_.Encode(above))[k], ASpace().max[k], 1e-12);
  }
}

TEST(PublishedGeneTest, HasThePapers48Bits) { EXPECT_EQ(GeneCodec(ASpace(), 8).num_bits(), 48); }

}  // namespace
}  // namespace visavis
