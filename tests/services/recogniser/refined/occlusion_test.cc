#include "services/recogniser/refined/occlusion.h"

#include <gtest/gtest.h>

#include "common/core/random.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

class OcclusionTest : public ::testing::Test {
 protected:
  OcclusionTest() : texture_(Face()), samples_(Face().size()) {
    Random random(3);
    for (std::size_t i = 0; i < Face().size(); ++i) {
      samples_.value[i] = static_cast<float>(10 * random.Normal());
      samples_.seen[i] = 1;
    }
    texture_.Learn(kFineBand, samples_);
    for (float& value : samples_.value) value = 0.6f * value + 20;  // another light
  }
  static const FacePoints& Face() { return SharedAdultHead().face; }

  /// Shows something else where @p is_hidden(point).
  template <typename Hidden>
  void Hide(const Hidden& is_hidden) {
    Random random(4);
    for (std::size_t i = 0; i < Face().size(); ++i) {
      if (is_hidden(Face().points[i]))
        samples_.value[i] = 20 + static_cast<float>(6 * random.Normal());
    }
  }
  /// Of the points in and out of the hidden part, the shares that count as seen.
  template <typename Hidden>
  std::pair<double, double> SeenInAndOut(const Hidden& is_hidden) const {
    double seen[2] = {0, 0}, count[2] = {0, 0};
    for (std::size_t i = 0; i < Face().size(); ++i) {
      const std::size_t out = is_hidden(Face().points[i]) ? 0 : 1;
      count[out] += 1;
      seen[out] += samples_.seen[i];
    }
    return {seen[0] / count[0], seen[1] / count[1]};
  }

  FaceTexture texture_;
  FaceSamples samples_;
};

TEST_F(OcclusionTest, AFreeFaceIsSeenWhole) {
  const FaceSamples before = samples_;
  EXPECT_EQ(HideOccluded(texture_, kFineBand, {&samples_, nullptr}), 0);
  EXPECT_EQ(samples_.seen, before.seen);
}

TEST_F(OcclusionTest, WhatCoversAPartOfTheFaceIsLeftOutAndNothingElse) {
  const auto cheek = [](const Eigen::Vector3f& p) { return p.x() > 0.02f && p.y() > 0.02f; };
  const auto upper_half = [](const Eigen::Vector3f& p) { return p.y() < 0.04f; };
  const FaceSamples before = samples_;
  Hide(cheek);
  EXPECT_GT(HideOccluded(texture_, kFineBand, {&samples_, nullptr}), 0.05);
  EXPECT_LT(SeenInAndOut(cheek).first, 0.1);
  EXPECT_GT(SeenInAndOut(cheek).second, 0.95);
  samples_ = before;
  Hide(upper_half);
  EXPECT_GT(HideOccluded(texture_, kFineBand, {&samples_, nullptr}), 0.3);
  EXPECT_LT(SeenInAndOut(upper_half).first, 0.2);
  EXPECT_GT(SeenInAndOut(upper_half).second, 0.9);
}

TEST_F(OcclusionTest, AFaceThatIsNowhereAsLearnedIsNotExplainedAway) {
  const FaceSamples before = samples_;
  Hide([](const Eigen::Vector3f&) { return true; });
  EXPECT_EQ(HideOccluded(texture_, kFineBand, {&samples_, nullptr}), 0);
  EXPECT_EQ(samples_.seen, before.seen);
  const GainOffset fit =
      FitPattern(samples_, texture_.pattern(kFineBand), texture_.known(kFineBand));
  EXPECT_LT(fit.correlation, 0.3);
}

TEST_F(OcclusionTest, AnEyeThatSeesNothingOfTheFaceIsJudgedByTheOthersLight) {
  FaceSamples free = samples_;
  const auto all = [](const Eigen::Vector3f&) { return true; };
  Hide(all);
  const FaceSamples covered = samples_;
  EXPECT_EQ(HideOccluded(texture_, kFineBand, {&samples_, nullptr}), 0);
  samples_ = covered;
  const std::vector<unsigned char> before = free.seen;
  EXPECT_NEAR(HideOccluded(texture_, kFineBand, {&free, &samples_}), 0.5, 0.06);
  EXPECT_EQ(free.seen, before);
  EXPECT_LT(SeenInAndOut(all).first, 0.1);
}

TEST_F(OcclusionTest, ThePictureOfAHalfHiddenFaceFitsOnceTheHandIsLeftOut) {
  Hide([](const Eigen::Vector3f& p) { return p.x() > 0; });
  const double before =
      FitPattern(samples_, texture_.pattern(kFineBand), texture_.known(kFineBand)).correlation;
  HideOccluded(texture_, kFineBand, {&samples_, nullptr});
  const double after =
      FitPattern(samples_, texture_.pattern(kFineBand), texture_.known(kFineBand)).correlation;
  EXPECT_LT(before, 0.85);
  EXPECT_GT(after, 0.95);
}

TEST_F(OcclusionTest, BesideWhatHidesOnlyPartsThatCertainlyShowTheFaceAreKept) {
  const auto slanted = [](const Eigen::Vector3f& p) { return p.x() + 0.7f * p.y() > 0.03f; };
  Hide(slanted);
  HideOccluded(texture_, kFineBand, {&samples_, nullptr});
  const double left = SeenInAndOut(slanted).first;
  EXPECT_GT(left, 0.05);
  KeepCertain(texture_, kFineBand, {&samples_, nullptr});
  EXPECT_LT(SeenInAndOut(slanted).first, 0.3 * left);
  EXPECT_GT(SeenInAndOut(slanted).second, 0.5);
}

}  // namespace
}  // namespace visavis
