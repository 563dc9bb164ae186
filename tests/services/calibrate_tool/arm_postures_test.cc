#include "services/calibrate_tool/arm_postures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/board_log.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

arm_state_t State(std::int64_t utime_us, const RigidTransform& X_BH, double speed) {
  arm_state_t state{};
  state.utime = utime_us;
  state.num_joints = 6;
  state.joint_names = {"turn_x", "turn_y", "turn_z", "x", "y", "z"};
  const auto q = GantryJoints(X_BH);
  state.joint_position = {q[5], q[4], q[3], q[0], q[1], q[2]};
  state.joint_velocity = {0, 0, speed, 0, 0, 0};
  return state;
}

TEST(ArmPosturesTest, AViewGetsTheHandsPoseAtItsTime) {
  const RigidTransform X_BH = MakeTransform(ExpRotation({0.3, -0.4, 1.2}), {0.5, -0.1, 0.8});
  ArmPostures postures(GantryArm(), 100);
  for (int i = 0; i < 10; ++i) postures.Add(State(10'000 * i, X_BH, 0.001));
  EXPECT_EQ(postures.num_states(), 10);
  const auto matched = postures.Match({{33'000, {}, {}}}, 0.02);
  ASSERT_EQ(matched.views.size(), 1u);
  EXPECT_EQ(matched.views[0].view.utime_us, 33'000);
  EXPECT_LT((matched.views[0].X_BH.matrix() - X_BH.matrix()).norm(), 1e-4);
}

TEST(ArmPosturesTest, ViewsWithoutStateOrWithAMovingArmAreLeftOutAndCounted) {
  ArmPostures postures(GantryArm(), 100);
  const RigidTransform X_BH = RigidTransform::Identity();
  for (int i = 0; i < 10; ++i) postures.Add(State(10'000 * i, X_BH, i < 5 ? 0.5 : 0));
  const auto matched =
      postures.Match({{20'000, {}, {}}, {80'000, {}, {}}, {500'000, {}, {}}}, 0.02);
  EXPECT_EQ(matched.views.size(), 1u);
  EXPECT_EQ(matched.num_moving, 1);
  EXPECT_EQ(matched.num_unknown, 1);
}

TEST(ArmPosturesTest, StatesOfOtherJointsAreRefusedByName) {
  ArmPostures postures(GantryArm(), 100);
  arm_state_t state = State(0, RigidTransform::Identity(), 0);
  state.joint_names[0] = "elbow";
  postures.Add(state);
  EXPECT_EQ(postures.num_states(), 0);
  EXPECT_THAT(postures.last_refusal(), HasSubstr("'turn_x'"));
}

}  // namespace
}  // namespace visavis
