#include "services/recogniser/frame_budget.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"
#include "tests/support/painted_head.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A frame whose time is part fixed, part in proportion to its evaluations.
double Ms(double fixed_ms, double share, double all_ms) { return fixed_ms + share * all_ms; }

TEST(FrameBudgetTest, FramesWithinTheBudgetRunAllEvaluations) {
  FrameBudget budget(10);
  for (int i = 0; i < 100; ++i) budget.Took(10, i % 2 == 0);
  EXPECT_EQ(budget.effort().tracking, 1);
  EXPECT_EQ(budget.effort().searching, 1);
  EXPECT_EQ(budget.complaint(), "");
}

TEST(FrameBudgetTest, FramesThatTakeLongerAreBroughtWithinItAndStayThere) {
  for (const double all_ms : {12.0, 30.0, 100.0}) {
    FrameBudget budget(10);
    int over = 0;
    for (int i = 0; i < 200; ++i) {
      const double ms = Ms(2, budget.effort().searching, all_ms);
      over += ms > 10;
      budget.Took(ms, true);
      if (i >= 20) {
        EXPECT_LE(ms, 10) << all_ms << " ms, frame " << i;
        EXPECT_GE(ms, 6) << all_ms << " ms, frame " << i;
      }
    }
    EXPECT_LT(over, 8) << all_ms;
  }
}

TEST(FrameBudgetTest, TrackedAndSearchedFramesAreJudgedApart) {
  FrameBudget budget(10);
  budget.Took(15, true);
  EXPECT_EQ(budget.effort().tracking, 1);
  EXPECT_NEAR(budget.effort().searching, 0.6, 1e-9);
  budget.Took(12, false);
  EXPECT_NEAR(budget.effort().tracking, 0.75, 1e-9);
  EXPECT_NEAR(budget.effort().searching, 0.6, 1e-9);
}

TEST(FrameBudgetTest, OneFrameThatWasInterruptedHalvesTheEffortAtMostAndItComesBackSlowly) {
  FrameBudget budget(10);
  budget.Took(5000, false);
  EXPECT_EQ(budget.effort().tracking, 0.5);
  for (int i = 0; i < 10; ++i) budget.Took(1, false);
  EXPECT_GT(budget.effort().tracking, 0.6);
  EXPECT_LT(budget.effort().tracking, 0.9);
  for (int i = 0; i < 20; ++i) budget.Took(1, false);
  EXPECT_EQ(budget.effort().tracking, 1);
}

TEST(FrameBudgetTest, ABudgetThatTheFewestEvaluationsExceedIsToldAndTakenBackOnceItIsKept) {
  FrameBudget budget(2);
  for (int i = 0; i < 40; ++i) budget.Took(7.5, true);
  EXPECT_EQ(budget.effort().searching, FrameBudget::kLeastShare);
  EXPECT_THAT(budget.complaint(), AllOf(HasSubstr("refined.budget_ms: 2: is too small"),
                                        HasSubstr("searched"), HasSubstr("7.5 ms")));
  budget.Took(1.9, true);
  EXPECT_EQ(budget.complaint(), "");
}

TEST(FrameBudgetTest, ABudgetBelowOneGenerationIsToldWhateverFramesTake) {
  FrameBudget budget(0.2);
  budget.SetGeneration(0.3);
  budget.Took(0.1, false);
  EXPECT_THAT(budget.complaint(), AllOf(HasSubstr("refined.budget_ms: 0.2: is too small"),
                                        HasSubstr("one generation takes 0.3 ms")));
  budget.SetGeneration(0.1);
  EXPECT_EQ(budget.complaint(), "");
}

TEST(FrameBudgetTest, WithoutABudgetNothingIsLoweredNorTold) {
  FrameBudget budget(0);
  budget.SetGeneration(1);
  for (int i = 0; i < 100; ++i) budget.Took(1e6, i % 2 == 0);
  EXPECT_EQ(budget.effort().tracking, 1);
  EXPECT_EQ(budget.effort().searching, 1);
  EXPECT_EQ(budget.complaint(), "");
}

double Ticks() {
  static double now_s = 0;
  return now_s += 0.001;
}

TEST(FrameBudgetTest, TheTimeOfAGenerationIsThatOfItsStage) {
  const StereoRig rig = TestRig();
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.start_X_CM = MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0, 0, 1));
  RefinedEstimator estimator(settings, HeadGeometry{}, rig);
  StageTimer timer(&Ticks);  // each stage takes a millisecond
  EXPECT_NEAR(LeastGenerationMs(rig, &estimator, &timer), 1, 1e-9);
}

}  // namespace
}  // namespace visavis
