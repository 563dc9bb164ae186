#include "services/arm_state/state_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::int64_t kStartUs = 5'000'000'000;

std::vector<ArmJoint> Joints() {
  return {{"lift", JointType::kPrismatic, -1, 1, 2}, {"turn", JointType::kRevolute, -3, 3, 2}};
}

JointReading Reading(std::int64_t t_us, double lift, double turn) {
  return {kStartUs + t_us, {"lift", "turn"}, {lift, turn}, {0.1, -0.2}};
}

class StateBuilderTest : public ::testing::Test {
 protected:
  const ArmSample* Add(const JointReading& reading, std::int64_t delay_us = 300) {
    return states_.Add(reading, reading.utime_us + delay_us);
  }
  // Expects @p reading to be refused for @p why.
  void ExpectRefused(const JointReading& reading, const std::string& why) {
    EXPECT_EQ(Add(reading), nullptr);
    EXPECT_THAT(states_.refusal(), HasSubstr(why));
  }
  StateBuilder states_{Joints(), StateOptions{}};
};

TEST_F(StateBuilderTest, AGoodReadingComesOutAsItIs) {
  const ArmSample* sample = Add(Reading(0, 0.3, 0.4));
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->utime_us, kStartUs);
  EXPECT_EQ(sample->q[0], 0.3);
  EXPECT_EQ(sample->q[1], 0.4);
  EXPECT_EQ(sample->qdot[0], 0.1);
  EXPECT_EQ(sample->qdot[1], -0.2);
  EXPECT_EQ(states_.counts().refused(), 0);
}

TEST_F(StateBuilderTest, JointsAreFoundByNameInAnyOrderAndAmongOthers) {
  const ArmSample* sample =
      Add({kStartUs, {"finger", "turn", "lift"}, {9, 0.4, 0.3}, {9, -0.2, 0.1}});
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->q[0], 0.3);
  EXPECT_EQ(sample->qdot[1], -0.2);
}

TEST_F(StateBuilderTest, AJointThatIsMissingOrThereTwiceIsNamed) {
  ExpectRefused({kStartUs, {"turn", "left"}, {0, 0}, {}}, "joint 'lift' of the URDF: is not among");
  ExpectRefused({kStartUs, {"lift", "turn", "turn"}, {0, 0, 0}, {}},
                "joint 'turn' of the URDF: is twice");
  ExpectRefused({kStartUs, {"lift", "turn"}, {0}, {}}, "1 positions and 0 velocities: must be 2");
  ExpectRefused({kStartUs, {"lift", "turn"}, {0, 0}, {0}},
                "2 positions and 1 velocities: must be 2");
  EXPECT_EQ(states_.counts().wrong_joints, 4);
}

TEST_F(StateBuilderTest, WithoutNamesTheUrdfsOrderHolds) {
  const ArmSample* sample = Add({kStartUs, {}, {0.3, 0.4}, {0.1, -0.2}});
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->q[1], 0.4);
  ExpectRefused({kStartUs + 1000, {}, {0, 0, 0}, {}}, "3 positions and 0 velocities: must be 2");
}

TEST(StateBuilderNamesTest, ConfiguredNamesHoldForASourceWithoutAndMustBeTheUrdfs) {
  StateOptions options;
  options.joint_names = {"turn", "lift"};
  StateBuilder states(Joints(), options);
  const ArmSample* sample = states.Add({kStartUs, {}, {0.4, 0.3}, {-0.2, 0.1}}, kStartUs);
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->q[0], 0.3);
  options.joint_names = {"turn", "elbow"};
  EXPECT_THAT([&] { StateBuilder(Joints(), options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("joint_names: joint 'lift'")));
}

TEST_F(StateBuilderTest, WhatIsNoNumberIsRefused) {
  ExpectRefused(Reading(0, std::nan(""), 0), "position of 'lift': not finite");
  ExpectRefused(Reading(0, 0, INFINITY), "position of 'turn': not finite");
  EXPECT_EQ(states_.counts().not_finite, 2);
}

TEST_F(StateBuilderTest, TimesMustGrow) {
  Add(Reading(10'000, 0, 0));
  ExpectRefused(Reading(10'000, 0, 0), "must be later than the last one's 5000010000");
  ExpectRefused(Reading(9'000, 0, 0), "utime: 5000009000");
  ExpectRefused({-1, {}, {0, 0}, {}}, "utime: -1: must be >= 0");
  EXPECT_EQ(states_.counts().wrong_time, 3);
  EXPECT_NE(Add(Reading(10'001, 0, 0)), nullptr);
  EXPECT_EQ(states_.counts().sessions, 0);
}

TEST_F(StateBuilderTest, AJumpBackOfMoreThanASecondIsANewSessionWithAnotherPlace) {
  Add(Reading(2'000'000, 0.9, 2.9));
  EXPECT_NE(Add(Reading(999'999, -0.9, -2.9)), nullptr);
  EXPECT_EQ(states_.counts().sessions, 1);
  ExpectRefused(Reading(0, 0, 0), "must be later");  // a second at most
}

TEST_F(StateBuilderTest, ImpossibleWaysAndSpeedsAreRefused) {
  Add(Reading(0, 0, 0));
  ExpectRefused(Reading(5'000, 0, 1), "position of 'turn': 1 after 0");
  JointReading fast = Reading(10'000, 0, 0);
  fast.velocity[0] = 100;
  ExpectRefused(fast, "velocity of 'lift': 100");
  ExpectRefused(Reading(15'000, 5, 0), "position of 'lift': 5: must be -1 to 1");
  EXPECT_EQ(states_.counts().impossible, 3);
}

TEST_F(StateBuilderTest, AnArmThatStaysElsewhereIsFollowedAndCounted) {
  Add(Reading(0, 0, 0));
  int refused = 0;
  std::int64_t t_us = 1000;
  while (Add(Reading(t_us, 0, 2)) == nullptr && refused < 100) {
    t_us += 1000;
    ++refused;
  }
  EXPECT_EQ(refused, JumpOptions{}.follow_after - 1);
  EXPECT_EQ(states_.counts().jumps_followed, 1);
}

TEST_F(StateBuilderTest, WithoutVelocitiesTheyAreTakenFromThePositions) {
  const auto reading = [](int i) {
    const double t_s = 0.005 * i;
    return JointReading{kStartUs + 5000 * i, {"lift", "turn"}, {0.5 * t_s, t_s - t_s * t_s}, {}};
  };
  EXPECT_EQ(Add(reading(0)), nullptr);
  EXPECT_EQ(states_.refusal(), "");
  const ArmSample* sample = nullptr;
  for (int i = 1; i < 30; ++i) sample = Add(reading(i));
  ASSERT_NE(sample, nullptr);
  EXPECT_NEAR(sample->qdot[0], 0.5, 1e-9);
  EXPECT_NEAR(sample->qdot[1], 1 - 2 * 0.145, 1e-9);
  EXPECT_EQ(states_.counts().differentiated, 30);
}

TEST_F(StateBuilderTest, AVelocityThatIsNanIsTakenFromThePositionsToo) {
  JointReading reading = Reading(0, 0, 0);
  reading.velocity[1] = std::nan("");
  EXPECT_EQ(Add(reading), nullptr);
  reading = Reading(10'000, 0.01, 0);
  reading.velocity[1] = std::nan("");
  const ArmSample* sample = Add(reading);
  ASSERT_NE(sample, nullptr);
  EXPECT_NEAR(sample->qdot[0], 1, 1e-9);
}

TEST_F(StateBuilderTest, NoVelocityIsTakenAcrossAGapAndGapsAreCounted) {
  const auto still = [](std::int64_t t_us, double lift) {
    return JointReading{kStartUs + t_us, {"lift", "turn"}, {lift, 0}, {}};
  };
  Add(still(0, 0));
  EXPECT_NE(Add(still(50'000, 0)), nullptr);
  EXPECT_EQ(states_.counts().gaps, 0);
  EXPECT_EQ(Add(still(350'000, 0.1)), nullptr);
  EXPECT_EQ(Add(still(350'000, 0.1)), nullptr);
  EXPECT_EQ(states_.counts().gaps, 1);
  EXPECT_EQ(states_.counts().largest_gap_us, 300'000);
}

TEST(StateBuilderTimesTest, MappedTimesAreTheHosts) {
  StateOptions options;
  options.map_times = true;
  StateBuilder states(Joints(), options);
  const std::int64_t offset_us = 1'700'000'000'000'000;
  const ArmSample* sample = nullptr;
  for (int i = 0; i < 100; ++i) {
    const std::int64_t t_us = 5000 * i, delay_us = i % 10 == 0 ? 100 : 3000;
    sample = states.Add({t_us, {}, {0, 0}, {0, 0}}, offset_us + t_us + delay_us);
  }
  ASSERT_NE(sample, nullptr);
  EXPECT_EQ(sample->utime_us, offset_us + 5000 * 99 + 100);
}

TEST_F(StateBuilderTest, AGoodReadingIsTakenWithoutAllocating) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  JointReading reading = Reading(0, 0, 0);
  Add(reading);
  reading.velocity[0] = std::nan("");
  const auto before = NumMallocs();
  for (int i = 0; i < 100; ++i) {
    reading.utime_us += 1000;
    Add(reading);
  }
  EXPECT_EQ(NumMallocs(), before);
  EXPECT_EQ(states_.counts().refused(), 0);
}

}  // namespace
}  // namespace visavis
