#include "services/recogniser/stage_timer.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

double now_s;
double Now() { return now_s; }

TEST(StageTimerTest, GivesEachStageItsOwnTimeAndAddsUpStagesEnteredAgain) {
  now_s = 100;
  StageTimer timer(&Now);
  timer.Restart();
  now_s += 0.001;  // other
  timer.Enter(Stage::kDecode);
  now_s += 0.002;
  timer.Enter(Stage::kMap);
  now_s += 0.004;
  timer.Enter(Stage::kDecode);
  now_s += 0.008;
  timer.Enter(Stage::kOther);
  EXPECT_NEAR(timer.Ms(Stage::kDecode), 10, 1e-9);
  EXPECT_NEAR(timer.Ms(Stage::kMap), 4, 1e-9);
  EXPECT_EQ(timer.Ms(Stage::kGeneration), 0);
  EXPECT_NEAR(timer.Ms(Stage::kOther), 1, 1e-9);
  EXPECT_NEAR(timer.TotalMs(), 15, 1e-9);
}

TEST(StageTimerTest, RestartForgetsAllStages) {
  now_s = 5;
  StageTimer timer(&Now);
  timer.Restart();
  timer.Enter(Stage::kGeneration);
  now_s += 1;
  timer.Restart();
  now_s += 0.5;
  timer.Enter(Stage::kMap);
  EXPECT_EQ(timer.Ms(Stage::kGeneration), 0);
  EXPECT_NEAR(timer.TotalMs(), 500, 1e-9);
}

}  // namespace
}  // namespace visavis
