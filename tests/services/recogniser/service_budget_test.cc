// The budget of time: kept by the clock when live, never in a replay.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/services/recogniser/service_bench.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

constexpr int kPairs = 6;
constexpr double kNotKept_ms = 0.001;

RecogniserConfig Config(double budget_ms) {
  RecogniserConfig config;
  config.ego_motion = "none";
  config.refined.budget_ms = budget_ms;
  return config;
}

/// Four pairs without a head, then a head.
void Show(ServiceBench* bench) {
  static MeshScene scene(TestRig());
  bench->SendRig({TestRig(), std::nullopt, std::nullopt});
  for (int i = 0; i < kPairs; ++i) {
    const double x_mm = i < 4 ? 3000 : 40 + i;
    scene.Show(TransformFromPhi(PhiOf(x_mm, -20, 1000, 4, -8, 5)), FeaturedHead);
    bench->Send("STEREO_IMAGES", PairOf({0, scene.picture(0), scene.picture(1)}, 33'333 * i),
                33'333 * i);
  }
}

TEST(ServiceBudgetTest, LiveFramesBeyondTheBudgetMakeTheNextOnesRunFewerEvaluationsAndSaySo) {
  ServiceBench all(Config(0), "", 0, true), few(Config(kNotKept_ms), "", 0, true);
  Show(&all);
  Show(&few);
  const auto with_all = all.Poses(), with_few = few.Poses();
  ASSERT_EQ(with_few.size(), static_cast<std::size_t>(kPairs));
  EXPECT_EQ(with_few[0].evaluations, with_all[0].evaluations);
  EXPECT_FALSE(with_few[0].budget_reduced);
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LT(with_few[i].evaluations, with_few[i - 1].evaluations) << i;
    EXPECT_LT(with_few[i].evaluations, with_all[i].evaluations) << i;
    EXPECT_TRUE(with_few[i].budget_reduced) << i;
    EXPECT_FALSE(with_all[i].budget_reduced) << i;
  }
  EXPECT_GE(CounterOf(few.Status(), "pairs_with_fewer_evaluations"), 3);
  EXPECT_EQ(CounterOf(all.Status(), "pairs_with_fewer_evaluations"), 0);
}

TEST(ServiceBudgetTest, ABudgetTooSmallForOneGenerationIsToldAtStart) {
  ServiceBench bench(Config(kNotKept_ms), "", 0, true);
  bench.SendRig({TestRig(), std::nullopt, std::nullopt});
  EXPECT_THAT(bench.Status().last_error, HasSubstr("refined.budget_ms: 0.001: is too small: one "
                                                   "generation takes"));
  EXPECT_EQ(bench.Status().state, service_status_t::STATE_DEGRADED);
}

TEST(ServiceBudgetTest, AReplayNeverLooksAtTheClock) {
  ServiceBench without(Config(0)), with(Config(kNotKept_ms));
  Show(&without);
  Show(&with);
  EXPECT_EQ(with.PoseBytes(), without.PoseBytes());
  EXPECT_EQ(CounterOf(with.Status(), "pairs_with_fewer_evaluations"), 0);
  EXPECT_EQ(with.Status().last_error, "");
}

TEST(ServiceBudgetTest, AHeadIsFoundAndFollowedWithTheFewestEvaluations) {
  ServiceBench bench(Config(kNotKept_ms), "", 0, true);
  Show(&bench);
  EXPECT_EQ(bench.Poses().back().status, head_pose_t::STATUS_TRACKING);
}

}  // namespace
}  // namespace visavis
