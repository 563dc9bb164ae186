// RecogniserService: waiting for the camera's motion, and what HEAD_POSE tells of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/convert/pose_message.h"
#include "tests/services/recogniser/service_bench.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

RigDescription ArmRig() { return RigOnArm(TinyRig()); }
RigDescription FixedRig() { return {TinyRig(), std::nullopt, std::nullopt}; }

double Slide(std::int64_t t_us) { return 0.5e-6 * static_cast<double>(t_us); }
double Turn(std::int64_t t_us) { return -0.2e-6 * static_cast<double>(t_us); }
RigidTransform X_WCAt(std::int64_t t_us) { return CameraOnArm(ArmRig(), Slide(t_us), Turn(t_us)); }

class ServiceMotionTest : public ::testing::Test {
 protected:
  void SendArm(std::int64_t t_us, ServiceBench* bench) {
    bench->Send("ARM_STATE", ArmAt(t_us, Slide(t_us), Turn(t_us), 0.5, -0.2), t_us);
  }
  void SendPose(std::int64_t t_us, ServiceBench* bench) {
    bench->Send("CAMERA_POSE", ToMessage(X_WCAt(t_us), kBaseUs + t_us), t_us);
  }
  // Arm states each 10 ms from @p begin_us on, before @p end_us.
  void SendArms(std::int64_t begin_us, std::int64_t end_us, ServiceBench* bench) {
    for (std::int64_t t_us = begin_us; t_us < end_us; t_us += 10'000) SendArm(t_us, bench);
  }
  // A bench on an arm, its states there until 90 ms, with a wait of 15 ms.
  ServiceMotionTest() {
    bench_.SendRig(ArmRig());
    SendArms(0, 100'000, &bench_);
  }
  ServiceBench bench_{EasyConfig()};
};

TEST_F(ServiceMotionTest, APairWhoseMotionIsKnownDoesNotWait) {
  bench_.Send("STEREO_IMAGES", PairAt(85'000, TinyRig()), 95'000);
  EXPECT_EQ(bench_.Poses().size(), 1u);
  EXPECT_EQ(bench_.next_wake_us(), Service::kNever);
}

TEST_F(ServiceMotionTest, APairWaitsForTheStateAfterItAndGoesOutWithIt) {
  bench_.SendPair(96'000, TinyRig());
  EXPECT_TRUE(bench_.Poses().empty());
  EXPECT_EQ(bench_.next_wake_us(), 111'000);
  SendArm(100'000, &bench_);
  const auto poses = bench_.Poses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_EQ(poses[0].feedforward_source, head_pose_t::SOURCE_ARM);
  EXPECT_FALSE(poses[0].feedforward_extrapolated);
  EXPECT_EQ(bench_.next_wake_us(), Service::kNever);
  const auto timing = bench_.Read<recogniser_timing_t>("RECOGNISER_TIMING").at(0);
  EXPECT_EQ(timing.received_utime, kBaseUs + 96'000);
  EXPECT_EQ(timing.published_utime, kBaseUs + 100'000);
}

TEST_F(ServiceMotionTest, AStateBeforeTheExposureDoesNotEndTheWait) {
  bench_.SendPair(115'000, TinyRig());
  SendArm(100'000, &bench_);
  SendArm(110'000, &bench_);
  EXPECT_TRUE(bench_.Poses().empty());
  SendArm(120'000, &bench_);
  EXPECT_EQ(bench_.Poses().size(), 1u);
}

TEST_F(ServiceMotionTest, AfterTheWaitThePairGoesOutExtrapolatedAndSaysSo) {
  bench_.SendPair(96'000, TinyRig());
  // The next state comes late: the wake falls due before it.
  SendArm(150'000, &bench_);
  const auto poses = bench_.Poses();
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_TRUE(poses[0].feedforward_extrapolated);
  EXPECT_EQ(poses[0].feedforward_source, head_pose_t::SOURCE_ARM);
  EXPECT_TRUE(poses[0].has_world_pose);
  const auto timing = bench_.Read<recogniser_timing_t>("RECOGNISER_TIMING").at(0);
  EXPECT_EQ(timing.published_utime, kBaseUs + 111'000);  // 15 ms of log time
  const service_status_t status = bench_.Status();
  EXPECT_EQ(CounterOf(status, "pairs_with_extrapolated_motion"), 1);
  EXPECT_EQ(CounterOf(status, "pairs_without_motion"), 0);
}

TEST_F(ServiceMotionTest, TheWaitIsCountedFromThePairsArrival) {
  bench_.Send("STEREO_IMAGES", PairAt(96'000, TinyRig()), 130'000);
  EXPECT_EQ(bench_.next_wake_us(), 145'000);
}

TEST_F(ServiceMotionTest, ASecondPairSendsTheWaitingOneFirst) {
  bench_.SendPair(96'000, TinyRig());
  bench_.Send("STEREO_IMAGES", PairAt(99'000, TinyRig()), 99'000);
  ASSERT_EQ(bench_.Poses().size(), 1u);
  EXPECT_EQ(bench_.Poses()[0].utime, kBaseUs + 96'000);
  EXPECT_EQ(bench_.next_wake_us(), 114'000);
  SendArm(100'000, &bench_);
  const auto poses = bench_.Poses();
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses[1].utime, kBaseUs + 99'000);
  EXPECT_EQ(poses[1].seq, 1);
}

TEST_F(ServiceMotionTest, TheEndOfALogSendsTheWaitingPair) {
  bench_.SendPair(96'000, TinyRig());
  bench_.service().Finish();
  EXPECT_EQ(bench_.Poses().size(), 1u);
  bench_.service().Finish();
  EXPECT_EQ(bench_.Poses().size(), 1u);
}

TEST_F(ServiceMotionTest, WithArmWait0NoPairWaits) {
  RecogniserConfig config = EasyConfig();
  config.arm_wait_ms = 0;
  ServiceBench bench(config);
  bench.SendRig(ArmRig());
  SendArms(0, 100'000, &bench);
  bench.SendPair(96'000, TinyRig());
  ASSERT_EQ(bench.Poses().size(), 1u);
  EXPECT_TRUE(bench.Poses()[0].feedforward_extrapolated);
}

TEST_F(ServiceMotionTest, StatesOfAClockBeyondTheBoundAreNotUsedAndTheStatusSaysSo) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(ArmRig());
  const auto send = [&](std::int64_t t_us, double clock_offset_s) {
    arm_state_t state = ArmAt(t_us, Slide(t_us), Turn(t_us), 0.5, -0.2);
    state.clock_state = arm_state_t::CLOCK_SYNCHRONISED;
    state.clock_offset_s = clock_offset_s;
    bench.Send("ARM_STATE", state, t_us);
  };
  for (std::int64_t t_us = 0; t_us < 50'000; t_us += 10'000) send(t_us, 0.006);
  bench.SendPair(35'000, TinyRig());
  ASSERT_EQ(bench.Poses().size(), 1u);
  EXPECT_EQ(bench.Poses()[0].feedforward_source, head_pose_t::SOURCE_MISSING);
  service_status_t status = bench.Status();
  EXPECT_EQ(status.state, service_status_t::STATE_DEGRADED);
  EXPECT_THAT(status.state_text, HasSubstr("arm_state_t.clock_offset_s: 0.006: must be at most "
                                           "0.005 (arm_clock_bound_ms)"));
  EXPECT_EQ(CounterOf(status, "arm_states_refused_by_clock"), 5);

  for (std::int64_t t_us = 50'000; t_us < 100'000; t_us += 10'000) send(t_us, 0.001);
  bench.SendPair(85'000, TinyRig());
  ASSERT_EQ(bench.Poses().size(), 2u);
  EXPECT_EQ(bench.Poses()[1].feedforward_source, head_pose_t::SOURCE_ARM);
  status = bench.Status();
  EXPECT_EQ(status.state_text, "");
  EXPECT_EQ(CounterOf(status, "arm_states_refused_by_clock"), 5);
}

TEST_F(ServiceMotionTest, AnArmThatNeverCameIsNotWaitedForButFlagged) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(ArmRig());
  for (std::int64_t i = 0; i < 3; ++i) bench.SendPair(33'000 * i, TinyRig());
  const auto poses = bench.Poses();
  ASSERT_EQ(poses.size(), 3u);
  for (const head_pose_t& pose : poses) {
    EXPECT_TRUE(HasPose(pose));
    EXPECT_EQ(pose.feedforward_source, head_pose_t::SOURCE_MISSING);
    EXPECT_EQ(pose.feedforward, head_pose_t::FEEDFORWARD_NONE);
    EXPECT_FALSE(pose.has_world_pose);
  }
  const service_status_t status = bench.Status();
  EXPECT_EQ(status.state, service_status_t::STATE_DEGRADED);
  EXPECT_THAT(status.state_text, HasSubstr("ARM_STATE"));
  EXPECT_EQ(CounterOf(status, "pairs_with_extrapolated_motion"), 0);
  EXPECT_EQ(CounterOf(status, "pairs_without_motion"), 3);
}

TEST_F(ServiceMotionTest, AnArmThatFallsSilentIsFlaggedUntilItSpeaksAgain) {
  bench_.SendPair(90'000, TinyRig());
  EXPECT_EQ(bench_.Poses().back().feedforward_source, head_pose_t::SOURCE_ARM);
  EXPECT_EQ(bench_.Status().state_text, "");
  for (std::int64_t t_us = 200'000; t_us < 400'000; t_us += 33'000)
    bench_.SendPair(t_us, TinyRig());
  bench_.service().Finish();
  EXPECT_EQ(bench_.Poses().back().feedforward_source, head_pose_t::SOURCE_MISSING);
  EXPECT_FALSE(bench_.Poses().back().has_world_pose);
  EXPECT_THAT(bench_.Status().state_text, HasSubstr("ARM_STATE"));
  SendArms(400'000, 500'000, &bench_);
  bench_.SendPair(490'000, TinyRig());
  EXPECT_EQ(bench_.Poses().back().feedforward_source, head_pose_t::SOURCE_ARM);
  EXPECT_EQ(bench_.Status().state_text, "");
}

TEST_F(ServiceMotionTest, AFixedCameraIsNormal) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  for (std::int64_t i = 0; i < 3; ++i) bench.SendPair(33'000 * i, TinyRig());
  EXPECT_EQ(bench.Poses().size(), 3u);
  EXPECT_EQ(bench.Poses().back().feedforward_source, head_pose_t::SOURCE_NONE);
  EXPECT_EQ(bench.Status().state, service_status_t::STATE_RUNNING);
  const service_status_t status = bench.Status();
  for (const std::int64_t count : status.counters) EXPECT_EQ(count, 0);
}

TEST_F(ServiceMotionTest, TheFeedforwardIsToldOnceAStepIsKnown) {
  for (const char* mode : {"none", "jacobian", "exact"}) {
    RecogniserConfig config = EasyConfig();
    config.feedforward = mode;
    ServiceBench bench(config);
    bench.SendRig(ArmRig());
    SendArms(0, 100'000, &bench);
    bench.SendPair(30'000, TinyRig());
    bench.SendPair(63'000, TinyRig());
    const auto poses = bench.Poses();
    ASSERT_EQ(poses.size(), 2u);
    EXPECT_EQ(poses[0].feedforward, head_pose_t::FEEDFORWARD_NONE);  // no earlier pair
    const std::string word = mode;
    EXPECT_EQ(poses[1].feedforward, word == "none"       ? head_pose_t::FEEDFORWARD_NONE
                                    : word == "jacobian" ? head_pose_t::FEEDFORWARD_JACOBIAN
                                                         : head_pose_t::FEEDFORWARD_EXACT);
  }
}

void ExpectWorldPose(const head_pose_t& pose, const RigidTransform& X_WC) {
  ASSERT_TRUE(pose.has_world_pose);
  const RigidTransform X_WM = X_WC * FromMessage(pose);
  EXPECT_TRUE(ReadTransform("world", pose.p_WM_m, pose.q_WM_wxyz).isApprox(X_WM, 1e-6));
  EXPECT_GE(pose.q_WM_wxyz[0], 0);
}

TEST_F(ServiceMotionTest, TheWorldPoseIsXWcXCmByTheArm) {
  bench_.SendPair(37'000, TinyRig());
  ExpectWorldPose(bench_.Poses().at(0), X_WCAt(37'000));
}

TEST_F(ServiceMotionTest, TheWorldPoseIsXWcXCmByCameraPoses) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  for (std::int64_t t_us = 0; t_us < 100'000; t_us += 10'000) SendPose(t_us, &bench);
  bench.SendPair(37'000, TinyRig());
  ExpectWorldPose(bench.Poses().at(0), X_WCAt(37'000));
  EXPECT_EQ(bench.Poses()[0].feedforward_source, head_pose_t::SOURCE_CAMERA_POSE);
}

TEST_F(ServiceMotionTest, APairWaitsForCameraPosesToo) {
  ServiceBench bench(EasyConfig());
  bench.SendRig(FixedRig());
  SendPose(0, &bench);
  SendPose(30'000, &bench);
  bench.SendPair(50'000, TinyRig());
  EXPECT_TRUE(bench.Poses().empty());
  SendPose(60'000, &bench);
  ASSERT_EQ(bench.Poses().size(), 1u);
  ExpectWorldPose(bench.Poses()[0], X_WCAt(50'000));
}

TEST_F(ServiceMotionTest, RefusedMotionIsCountedNamedAndChangesNothing) {
  arm_state_t nan = ArmAt(95'000, std::nan(""), 0);
  bench_.Send("ARM_STATE", nan, 95'000);
  EXPECT_THAT(bench_.reporter().last_error(), HasSubstr("arm_state_t"));
  EXPECT_THAT(bench_.reporter().last_error(), HasSubstr("slide"));
  arm_state_t empty{};
  empty.utime = kBaseUs + 95'000;
  bench_.Send("ARM_STATE", empty, 95'000);  // zero joints
  bench_.Send("ARM_STATE", ArmAt(80'000, 0, 0), 95'000);
  rigid_transform_t pose = ToMessage(RigidTransform::Identity(), kBaseUs + 95'000);
  pose.quat[0] = std::nan("");
  bench_.Send("CAMERA_POSE", pose, 95'000);
  EXPECT_THAT(bench_.reporter().last_error(), HasSubstr("rigid_transform_t"));
  pose = ToMessage(RigidTransform::Identity(), -1);
  bench_.Send("CAMERA_POSE", pose, 95'000);
  EXPECT_EQ(bench_.reporter().rejected(), 5);
  bench_.SendPair(85'000, TinyRig());
  ExpectWorldPose(bench_.Poses().at(0), X_WCAt(85'000));
}

}  // namespace
}  // namespace visavis
