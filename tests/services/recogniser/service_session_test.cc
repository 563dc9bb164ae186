// RecogniserService: sessions, rigs and commands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "tests/services/recogniser/service_bench.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

RigDescription FixedRig() { return {TinyRig(), std::nullopt, std::nullopt}; }

// Confirms after three good frames, so that a new start shows.
RecogniserConfig SlowConfig() {
  RecogniserConfig config = EasyConfig();
  config.published.track.confirm_frames = 3;
  return config;
}

class ServiceSessionTest : public ::testing::Test {
 protected:
  ServiceSessionTest() { bench_.SendRig(FixedRig()); }
  // Sends pairs 33 ms apart until the head is tracked. @return the time of the last.
  std::int64_t Track(std::int64_t t_us) {
    for (int i = 0; i < 3; ++i) bench_.SendPair(t_us += 33'000, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
    return t_us;
  }
  int LastStatus() { return bench_.Poses().back().status; }
  ServiceBench bench_{SlowConfig()};
};

TEST_F(ServiceSessionTest, AJumpBackOfMoreThanASecondIsANewSession) {
  const std::int64_t t_us = Track(5'000'000);
  bench_.SendPair(t_us - 1'000'001, TinyRig());
  EXPECT_EQ(bench_.Poses().back().seq, 0);
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_SEARCHING);
  EXPECT_TRUE(HasPose(bench_.Poses().back()));
  // And the session lives: it is no error for ever.
  Track(t_us - 1'000'001);
  EXPECT_EQ(bench_.Poses().back().seq, 3);
  EXPECT_EQ(bench_.reporter().rejected(), 0);
}

TEST_F(ServiceSessionTest, AShorterJumpBackIsNot) {
  const std::int64_t t_us = Track(5'000'000);
  bench_.SendPair(t_us - 1'000'000, TinyRig());
  EXPECT_EQ(bench_.Poses().back().seq, 3);
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(bench_.Poses().back().feedforward, head_pose_t::FEEDFORWARD_NONE);
}

TEST_F(ServiceSessionTest, AJumpForwardIsNot) {
  Track(0);
  bench_.SendPair(3'600'000'000, TinyRig());
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
}

TEST_F(ServiceSessionTest, ALogThatIsPlayedAgainIsTrackedAgainWithItsMotion) {
  RigDescription rig = RigOnArm(TinyRig());
  bench_.SendRig(rig);
  for (int round = 0; round < 3; ++round) {
    for (std::int64_t t_us = 0; t_us < 3'000'000; t_us += 10'000) {
      bench_.Send("ARM_STATE", ArmAt(t_us, 0, 0), t_us + 4'000'000 * round);
      if (t_us % 100'000 != 50'000) continue;
      bench_.Send("STEREO_IMAGES", PairAt(t_us, TinyRig()), t_us + 4'000'000 * round);
    }
    const auto poses = bench_.Poses();
    ASSERT_EQ(poses.size(), static_cast<std::size_t>(30 * (round + 1)));
    EXPECT_EQ(poses.back().seq, 29);
    EXPECT_EQ(poses.back().status, head_pose_t::STATUS_TRACKING);
    EXPECT_EQ(poses.back().feedforward, head_pose_t::FEEDFORWARD_EXACT);
    EXPECT_EQ(poses[static_cast<std::size_t>(30 * round)].status, head_pose_t::STATUS_SEARCHING);
  }
  EXPECT_EQ(bench_.reporter().rejected(), 0);
}

TEST_F(ServiceSessionTest, APairThatWaitsBelongsToItsOwnSession) {
  bench_.SendRig(RigOnArm(TinyRig()));
  bench_.Send("ARM_STATE", ArmAt(5'000'000, 0, 0), 5'000'000);
  bench_.SendPair(5'005'000, TinyRig());  // waits
  bench_.Send("ARM_STATE", ArmAt(0, 0, 0), 5'010'000);
  const auto poses = bench_.Poses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].seq, 0);
  bench_.Send("STEREO_IMAGES", PairAt(0, TinyRig()), 5'011'000);
  EXPECT_EQ(bench_.Poses().back().seq, 0);
}

TEST_F(ServiceSessionTest, AnArmWhoseClockIsSecondsBehindDoesNotEndTheTrack) {
  bench_.SendRig(RigOnArm(TinyRig()));
  for (std::int64_t i = 0; i < 20; ++i) {
    const std::int64_t t_us = 5'000'000 + 33'000 * i;
    bench_.Send("ARM_STATE", ArmAt(t_us - 3'000'000, 0, 0), t_us);
    bench_.SendPair(t_us, TinyRig());
  }
  bench_.service().Finish();
  const auto poses = bench_.Poses();
  ASSERT_EQ(poses.size(), 20u);
  EXPECT_EQ(poses.back().seq, 19);
  EXPECT_EQ(poses.back().status, head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(poses.back().feedforward_source, head_pose_t::SOURCE_MISSING);
}

TEST_F(ServiceSessionTest, GarbageTimesStartNoSession) {
  const std::int64_t t_us = Track(5'000'000);
  images_t pair = PairAt(0, TinyRig());
  for (const std::int64_t utime :
       {std::int64_t{-1}, std::int64_t{-5'000'000}, std::numeric_limits<std::int64_t>::min()}) {
    pair.utime = utime;
    bench_.Send("STEREO_IMAGES", pair, t_us);
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_LOST);
  }
  arm_state_t arm = ArmAt(0, 0, 0);
  arm.utime = -7'000'000;
  bench_.Send("ARM_STATE", arm, t_us);
  bench_.SendPair(t_us + 33'000, TinyRig());
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(bench_.Poses().back().seq, 6);
}

TEST_F(ServiceSessionTest, ARigThatIsRepeatedChangesNothing) {
  std::int64_t t_us = Track(0);
  for (int i = 0; i < 5; ++i) {
    bench_.SendRig(FixedRig(), t_us += 1'000'000);
    bench_.SendPair(t_us, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
  }
}

TEST_F(ServiceSessionTest, ARigThatChangedStartsAnew) {
  const std::function<void(RigDescription*)> changes[] = {
      [](RigDescription* rig) { rig->rig.right.fx += 0.01; },
      [](RigDescription* rig) { rig->rig.left.distortion[0] = 0.01; },
      [](RigDescription* rig) { rig->rig.X_CL.translation().x() -= 0.001; },
      [](RigDescription* rig) { *rig = RigOnArm(rig->rig); }};
  std::int64_t t_us = 0;
  for (const auto& change : changes) {
    bench_.SendRig(FixedRig(), t_us);
    t_us = Track(t_us);
    const std::int64_t seq = bench_.Poses().back().seq;
    RigDescription rig = FixedRig();
    change(&rig);
    bench_.SendRig(rig, t_us);
    bench_.SendPair(t_us += 33'000, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_SEARCHING);
    EXPECT_EQ(bench_.Poses().back().seq, seq + 1);  // the session goes on
  }
}

TEST_F(ServiceSessionTest, APairThatWaitsIsAnsweredWithItsOwnRig) {
  bench_.SendRig(RigOnArm(TinyRig()));
  bench_.Send("ARM_STATE", ArmAt(0, 0, 0), 0);
  bench_.SendPair(5'000, TinyRig());  // waits
  bench_.SendRig({SmallRig(), std::nullopt, std::nullopt}, 6'000);
  ASSERT_EQ(bench_.Poses().size(), 1u);
  EXPECT_TRUE(HasPose(bench_.Poses()[0]));
}

TEST_F(ServiceSessionTest, ARefusedRigLeavesTheGoodOneInUse) {
  std::int64_t t_us = Track(0);
  const double nan = std::nan("");
  const std::pair<const char*, std::function<void(stereo_rig_t*)>> refused[] = {
      {"fx", [](stereo_rig_t* rig) { rig->right.fx_px = 0; }},
      {"X_CL", [&](stereo_rig_t* rig) { rig->p_CL_m[1] = nan; }},
      {"X_CL", [](stereo_rig_t* rig) { rig->q_CL_wxyz[0] = 2; }},
      {"width", [](stereo_rig_t* rig) { rig->left.width = 0; }},
      {"foot",
       [](stereo_rig_t* rig) {
         rig->arm_urdf = kArmUrdf;
         rig->arm_base_link = "base";
         rig->arm_tip_link = "foot";
       }},
      {"URDF", [](stereo_rig_t* rig) {
         rig->arm_urdf = "<robot";
         rig->arm_base_link = "base";
         rig->arm_tip_link = "hand";
       }}};
  std::int64_t count = 0;
  for (const auto& [reason, change] : refused) {
    stereo_rig_t rig = ToMessage(FixedRig(), kBaseUs);
    change(&rig);
    bench_.Send("STEREO_RIG", rig, t_us);
    EXPECT_EQ(bench_.reporter().rejected(), ++count);
    EXPECT_THAT(bench_.reporter().last_error(), HasSubstr(reason));
    bench_.SendPair(t_us += 33'000, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING) << reason;
    EXPECT_EQ(bench_.Poses().back().feedforward_source, head_pose_t::SOURCE_NONE) << reason;
  }
}

recogniser_command_t Command() {
  recogniser_command_t command{};
  command.utime = kBaseUs;
  return command;
}

recogniser_command_t SpaceCommand(double min_x_m, double max_x_m) {
  recogniser_command_t command = Command();
  command.set_search_space = true;
  const double min[] = {min_x_m, -0.2, 0.9, -0.3, -0.3, -0.3};
  const double max[] = {max_x_m, 0.2, 1.2, 0.3, 0.3, 0.3};
  std::copy(min, min + 6, command.search_min);
  std::copy(max, max + 6, command.search_max);
  return command;
}

TEST_F(ServiceSessionTest, ResetForgetsTheHead) {
  const std::int64_t t_us = Track(0);
  recogniser_command_t command = Command();
  command.reset = true;
  bench_.Send("RECOGNISER_COMMAND", command, t_us);
  bench_.SendPair(t_us + 33'000, TinyRig());
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_SEARCHING);
  EXPECT_EQ(bench_.Poses().back().seq, 3);  // the session goes on
}

TEST_F(ServiceSessionTest, TheEstimatorChangesByCommandAndLooksForTheHeadAfresh) {
  const std::int64_t t_us = Track(0);
  recogniser_command_t command = Command();
  command.estimator = "published";  // as it is: nothing happens
  bench_.Send("RECOGNISER_COMMAND", command, t_us);
  bench_.SendPair(t_us + 33'000, TinyRig());
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING);
  const int evaluations = bench_.Poses().back().evaluations;
  command.estimator = "refined";
  bench_.Send("RECOGNISER_COMMAND", command, t_us + 33'000);
  bench_.SendPair(t_us + 66'000, TinyRig());
  EXPECT_EQ(LastStatus(), head_pose_t::STATUS_SEARCHING);
  EXPECT_NE(bench_.Poses().back().evaluations, evaluations);
  EXPECT_EQ(bench_.Poses().back().seq, 4);  // the session goes on
}

TEST_F(ServiceSessionTest, PausedPairsAreLostWithoutEvaluationUntilThePauseEnds) {
  std::int64_t t_us = Track(0);
  recogniser_command_t command = Command();
  command.pause = recogniser_command_t::SWITCH_ON;
  bench_.Send("RECOGNISER_COMMAND", command, t_us);
  EXPECT_THAT(bench_.Status().state_text, HasSubstr("paused"));
  command.pause = recogniser_command_t::SWITCH_KEEP;
  bench_.Send("RECOGNISER_COMMAND", command, t_us);
  for (int i = 0; i < 3; ++i) {
    bench_.SendPair(t_us += 33'000, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_LOST);
    EXPECT_EQ(bench_.Poses().back().evaluations, 0);
    EXPECT_FALSE(HasPose(bench_.Poses().back()));
  }
  command.pause = recogniser_command_t::SWITCH_OFF;
  bench_.Send("RECOGNISER_COMMAND", command, t_us);
  EXPECT_EQ(bench_.Status().state_text, "");
  bench_.SendPair(t_us += 33'000, TinyRig());
  EXPECT_TRUE(HasPose(bench_.Poses().back()));
  EXPECT_EQ(bench_.Poses().back().seq, 6);
}

TEST_F(ServiceSessionTest, FeedforwardChangesByCommandAndOutlivesANewRig) {
  bench_.SendRig(RigOnArm(TinyRig()));
  for (std::int64_t t_us = 0; t_us < 300'000; t_us += 10'000) {
    bench_.Send("ARM_STATE", ArmAt(t_us, 0, 0), t_us);
  }
  recogniser_command_t command = Command();
  command.feedforward = "jacobian";
  bench_.SendPair(30'000, TinyRig());
  bench_.Send("RECOGNISER_COMMAND", command, 300'000);
  bench_.SendPair(60'000, TinyRig());
  EXPECT_EQ(bench_.Poses().back().feedforward, head_pose_t::FEEDFORWARD_JACOBIAN);
  RigDescription rig = RigOnArm(TinyRig());
  rig.rig.right.fx += 1;
  bench_.SendRig(rig, 300'000);
  for (std::int64_t t_us = 300'000; t_us < 400'000; t_us += 10'000) {
    bench_.Send("ARM_STATE", ArmAt(t_us, 0, 0), t_us);
  }
  bench_.SendPair(330'000, TinyRig());
  bench_.SendPair(360'000, TinyRig());
  EXPECT_EQ(bench_.Poses().back().feedforward, head_pose_t::FEEDFORWARD_JACOBIAN);
}

TEST_F(ServiceSessionTest, ASearchSpaceByCommandBoundsThePoseAndOutlivesANewRig) {
  bench_.Send("RECOGNISER_COMMAND", SpaceCommand(0.5, 0.6), 0);
  const auto expect_inside = [&] {
    EXPECT_GE(bench_.Poses().back().p_CM_m[0], 0.5 - 1e-9);
    EXPECT_LE(bench_.Poses().back().p_CM_m[0], 0.6 + 1e-9);
  };
  bench_.SendPair(0, TinyRig());
  expect_inside();
  RigDescription rig = FixedRig();
  rig.rig.right.fx += 1;
  bench_.SendRig(rig, 10'000);
  bench_.SendPair(33'000, TinyRig());
  expect_inside();
}

TEST_F(ServiceSessionTest, CommandsBeforeTheRigAreKept) {
  ServiceBench bench(SlowConfig());
  recogniser_command_t command = SpaceCommand(0.5, 0.6);
  command.feedforward = "none";
  bench.Send("RECOGNISER_COMMAND", command, 0);
  bench.SendRig(FixedRig());
  bench.SendPair(0, TinyRig());
  EXPECT_GE(bench.Poses().back().p_CM_m[0], 0.5 - 1e-9);
  EXPECT_EQ(bench.reporter().rejected(), 0);
}

// A message with a value out of range is refused whole: the good fields beside it change nothing.
TEST_F(ServiceSessionTest, ABadCommandIsCountedNamedAndRefusedWhole) {
  const std::pair<const char*, std::function<void(recogniser_command_t*)>> refused[] = {
      {"feedforward", [](auto* c) { c->feedforward = "magic"; }},
      {"estimator", [](auto* c) { c->estimator = "refined9"; }},
      {"pause", [](auto* c) { c->pause = 7; }},
      {"utime", [](auto* c) { c->utime = -1; }},
      {"search_max", [](auto* c) { c->search_max[0] = c->search_min[0]; }},
      {"search_min", [](auto* c) { c->search_min[2] = 0.1; }},
      {"search_max", [](auto* c) { c->search_max[4] = 1.5; }},
      {"search_max", [](auto* c) { c->search_min[3] = std::nan(""); }}};
  std::int64_t t_us = Track(0), count = 0;
  for (const auto& [field, spoil] : refused) {
    recogniser_command_t command = SpaceCommand(0.5, 0.6);
    command.pause = recogniser_command_t::SWITCH_ON;
    command.reset = true;
    spoil(&command);
    bench_.Send("RECOGNISER_COMMAND", command, t_us);
    EXPECT_EQ(bench_.reporter().rejected(), ++count) << field;
    EXPECT_THAT(bench_.reporter().last_error(), HasSubstr(field));
    bench_.SendPair(t_us += 33'000, TinyRig());
    EXPECT_EQ(LastStatus(), head_pose_t::STATUS_TRACKING) << field;
    EXPECT_LT(bench_.Poses().back().p_CM_m[0], 0.45) << field;
  }
}

// A bad field in a space that is not to be set is nobody's business.
TEST_F(ServiceSessionTest, ASearchSpaceThatIsNotSetIsNotChecked) {
  recogniser_command_t command = Command();
  command.search_min[0] = std::nan("");
  bench_.Send("RECOGNISER_COMMAND", command, 0);
  EXPECT_EQ(bench_.reporter().rejected(), 0);
}

TEST_F(ServiceSessionTest, HeadPoseHoldsNoClockReading) {
  const auto run = [](std::int64_t clock_offset_us) {
    RecogniserConfig config = SlowConfig();
    ServiceBench bench(config, "", clock_offset_us);
    bench.SendRig(RigOnArm(TinyRig()));
    for (std::int64_t t_us = 0; t_us < 500'000; t_us += 10'000) {
      if (t_us % 70'000 != 0)
        bench.Send("ARM_STATE", ArmAt(t_us, 1e-7 * static_cast<double>(t_us), 0), t_us);
      if (t_us % 30'000 == 0)
        bench.Send("STEREO_IMAGES", PairAt(t_us + 5'000, TinyRig()), t_us + 9'000);
    }
    bench.service().Finish();
    EXPECT_EQ(bench.Poses().size(), 17u);
    return bench.PoseBytes();
  };
  EXPECT_EQ(run(0), run(987'654'321));
}

}  // namespace
}  // namespace visavis
