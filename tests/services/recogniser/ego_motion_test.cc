#include "services/recogniser/ego_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/services/recogniser/sliding_arm.h"

namespace visavis {
namespace {

using Choice = EgoMotion::Choice;
using Source = EgoMotionSource;

constexpr std::int64_t kT0Us = 1'000'000'000;

RigDescription RigWithArm() { return RigOnArm(SmallRig()); }
RigDescription RigWithoutArm() { return {SmallRig(), std::nullopt, std::nullopt}; }

// Joints at a time: slide 0.1 m + 0.5 m/s t, turn 0.2 rad - 0.3 rad/s t.
double Slide(std::int64_t t_us) { return 0.1 + 0.5e-6 * static_cast<double>(t_us); }
double Turn(std::int64_t t_us) { return 0.2 - 0.3e-6 * static_cast<double>(t_us); }
std::string AddArm(std::int64_t t_us, EgoMotion* motion) {
  return motion->AddArmState(kT0Us + t_us, kArmJoints, {Slide(t_us), Turn(t_us)}, {0.5, -0.3});
}
RigidTransform CameraAt(std::int64_t t_us) {
  return CameraOnArm(RigWithArm(), Slide(t_us), Turn(t_us));
}
std::string AddPose(std::int64_t t_us, EgoMotion* motion) {
  return motion->AddCameraPose(kT0Us + t_us, CameraAt(t_us));
}

TEST(EgoMotionTest, KnowsTheFourChoicesByName) {
  EXPECT_EQ(EgoMotion::ParseChoice("auto"), Choice::kAuto);
  EXPECT_EQ(EgoMotion::ParseChoice("arm"), Choice::kArm);
  EXPECT_EQ(EgoMotion::ParseChoice("camera_pose"), Choice::kCameraPose);
  EXPECT_EQ(EgoMotion::ParseChoice("none"), Choice::kNone);
  EXPECT_THAT([] { EgoMotion::ParseChoice("odometry"); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::AllOf(
                  ::testing::HasSubstr("ego_motion"), ::testing::HasSubstr("odometry"),
                  ::testing::HasSubstr("must be auto, arm, camera_pose or none"))));
}

TEST(EgoMotionTest, NoneIsNoMotionWhateverComes) {
  EgoMotion motion(Choice::kNone);
  motion.SetRig(RigWithArm());
  for (const std::int64_t t_us : {0, 10'000, 20'000}) {
    AddArm(t_us, &motion);
    AddPose(t_us, &motion);
  }
  EXPECT_EQ(motion.source(), Source::kNone);
  EXPECT_FALSE(motion.missing());
  EXPECT_FALSE(motion.At(kT0Us + 10'000));
  EXPECT_TRUE(motion.IsCertainAt(kT0Us + 99'000'000));
  EXPECT_FALSE(motion.Between(kT0Us, kT0Us + 10'000).known);
}

TEST(EgoMotionTest, AutoOnAFixedCameraIsNoneAndNothingIsMissing) {
  EgoMotion motion(Choice::kAuto);
  EXPECT_EQ(motion.source(), Source::kNone);
  motion.SetRig(RigWithoutArm());
  EXPECT_EQ(motion.source(), Source::kNone);
  EXPECT_FALSE(motion.missing());
  EXPECT_TRUE(motion.IsCertainAt(kT0Us));
}

TEST(EgoMotionTest, AutoOnAnArmWaitsForItsStatesAndSaysThatTheyAreMissing) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  EXPECT_EQ(motion.source(), Source::kArm);
  EXPECT_TRUE(motion.missing());
  AddArm(0, &motion);
  EXPECT_EQ(motion.source(), Source::kArm);
  EXPECT_FALSE(motion.missing());
}

TEST(EgoMotionTest, AutoTakesCameraPosesWhereTheyComeAndTheArmBeforeThem) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  AddPose(0, &motion);
  EXPECT_EQ(motion.source(), Source::kCameraPose);
  EXPECT_FALSE(motion.missing());
  AddArm(0, &motion);
  EXPECT_EQ(motion.source(), Source::kArm);
}

TEST(EgoMotionTest, ArmWithoutAnArmInTheRigIsMissing) {
  EgoMotion motion(Choice::kArm);
  EXPECT_TRUE(motion.missing());
  motion.SetRig(RigWithoutArm());
  AddPose(0, &motion);
  EXPECT_EQ(AddArm(0, &motion), "");  // there is no arm to take it
  EXPECT_EQ(motion.source(), Source::kArm);
  EXPECT_TRUE(motion.missing());
  EXPECT_FALSE(motion.At(kT0Us));
  EXPECT_TRUE(motion.IsCertainAt(kT0Us));  // nothing to wait for
}

TEST(EgoMotionTest, CameraPoseDoesNotHeedTheArm) {
  EgoMotion motion(Choice::kCameraPose);
  motion.SetRig(RigWithArm());
  AddArm(0, &motion);
  EXPECT_EQ(motion.source(), Source::kCameraPose);
  EXPECT_TRUE(motion.missing());
  AddPose(0, &motion);
  EXPECT_FALSE(motion.missing());
}

TEST(EgoMotionTest, TheCameraOnAnArmIsXWbXBhXHc) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  for (std::int64_t t_us = 0; t_us <= 50'000; t_us += 10'000) EXPECT_EQ(AddArm(t_us, &motion), "");
  for (const std::int64_t t_us : {0, 5'000, 23'456, 50'000}) {
    const auto camera = motion.At(kT0Us + t_us);
    ASSERT_TRUE(camera);
    EXPECT_TRUE(camera->X_WC.isApprox(CameraAt(t_us), 1e-9)) << t_us;
    EXPECT_FALSE(camera->extrapolated);
  }
  const auto beyond = motion.At(kT0Us + 58'000);
  ASSERT_TRUE(beyond);
  EXPECT_TRUE(beyond->extrapolated);
  EXPECT_TRUE(beyond->X_WC.isApprox(CameraAt(58'000), 1e-6));
  EXPECT_FALSE(motion.At(kT0Us + 61'000));  // more than a period beyond
  EXPECT_FALSE(motion.At(kT0Us - 1));
}

TEST(EgoMotionTest, IsCertainOnceASampleAtOrAfterTheExposureCame) {
  for (const bool by_arm : {false, true}) {
    EgoMotion motion(by_arm ? Choice::kArm : Choice::kCameraPose);
    motion.SetRig(RigWithArm());
    const auto add = by_arm ? AddArm : AddPose;
    EXPECT_TRUE(motion.IsCertainAt(kT0Us));  // nothing comes yet
    add(0, &motion);
    EXPECT_TRUE(motion.IsCertainAt(kT0Us - 5));
    EXPECT_TRUE(motion.IsCertainAt(kT0Us));
    EXPECT_FALSE(motion.IsCertainAt(kT0Us + 1));
    add(10'000, &motion);
    EXPECT_TRUE(motion.IsCertainAt(kT0Us + 10'000));
  }
}

class EgoMotionStepTest : public ::testing::TestWithParam<Choice> {
 protected:
  EgoMotionStepTest() {
    motion_.SetRig(RigWithArm());
    for (std::int64_t t_us = 0; t_us <= 100'000; t_us += 10'000) {
      AddArm(t_us, &motion_);
      AddPose(t_us, &motion_);
    }
  }
  EgoMotion motion_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Sources, EgoMotionStepTest,
                         ::testing::Values(Choice::kArm, Choice::kCameraPose));

TEST_P(EgoMotionStepTest, LeadsFromTheEarlierCameraToTheLater) {
  const CameraStep step = motion_.Between(kT0Us + 20'000, kT0Us + 50'000);
  ASSERT_TRUE(step.known);
  EXPECT_DOUBLE_EQ(step.dt_s, 0.03);
  EXPECT_TRUE(step.X_WC1.isApprox(CameraAt(20'000), 1e-9));
  EXPECT_TRUE(step.X_C2C1.isApprox(CameraAt(50'000).inverse() * CameraAt(20'000), 1e-9));
  // A head at rest is carried along with it.
  const RigidTransform X_WM = CameraAt(20'000) * TransformFromPhi(PhiOf(30, -20, 1000, 5, -4, 3));
  const Vector6d carried = Carry(step.X_C2C1, PhiFromTransform(CameraAt(20'000).inverse() * X_WM));
  EXPECT_TRUE(TransformFromPhi(carried).isApprox(CameraAt(50'000).inverse() * X_WM, 1e-9));
}

TEST_P(EgoMotionStepTest, ItsTwistIsTheCamerasVelocity) {
  const CameraStep step = motion_.Between(kT0Us + 20'000, kT0Us + 50'000);
  const RigidTransform X_WB = RigWithArm().arm->X_WB;
  // The hand turns at -0.3 rad/s about the base's y; poses give the mean over the step.
  EXPECT_TRUE(step.twist_1.w_WC.isApprox(X_WB.linear() * Eigen::Vector3d(0, -0.3, 0), 1e-6));
  const Eigen::Vector3d v_mean =
      (CameraAt(50'000).translation() - CameraAt(20'000).translation()) / 0.03;
  const Eigen::Vector3d v_1 =
      (CameraAt(20'001).translation() - CameraAt(19'999).translation()) / 2e-6;
  const Eigen::Vector3d& expected = GetParam() == Choice::kArm ? v_1 : v_mean;
  EXPECT_LT((step.twist_1.v_WC - expected).norm(), 1e-6);
}

TEST_P(EgoMotionStepTest, NoStepLeadsBackwardsOrNowhere) {
  EXPECT_FALSE(motion_.Between(kT0Us + 20'000, kT0Us + 20'000).known);
  EXPECT_FALSE(motion_.Between(kT0Us + 20'000, kT0Us + 10'000).known);
  EXPECT_FALSE(motion_.Between(kT0Us - 10'000, kT0Us + 10'000).known);
  EXPECT_FALSE(motion_.Between(kT0Us + 10'000, kT0Us + 900'000).known);
  EXPECT_TRUE(motion_.Between(kT0Us + 10'000, kT0Us + 105'000).known);
}

TEST_P(EgoMotionStepTest, ANewSessionForgetsTheSamplesOfTheOld) {
  motion_.ForgetSamplesAfter(kT0Us + 50'000);
  EXPECT_TRUE(motion_.missing());
  EXPECT_FALSE(motion_.At(kT0Us + 10'000));
  EXPECT_EQ(AddArm(0, &motion_), "");  // older than before, and taken
  EXPECT_EQ(AddPose(0, &motion_), "");
}

TEST_P(EgoMotionStepTest, SamplesOfTheNewSessionThatCameBeforeItsFirstPairAreKept) {
  motion_.ForgetSamplesAfter(kT0Us + 100'000);
  EXPECT_TRUE(motion_.At(kT0Us + 10'000));
}

TEST(EgoMotionTest, ARefusedSampleSaysWhy) {
  using ::testing::HasSubstr;
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  EXPECT_EQ(AddArm(10'000, &motion), "");
  EXPECT_NE(AddArm(10'000, &motion), "");  // again
  EXPECT_NE(AddArm(5'000, &motion), "");   // older
  const double nan = std::nan("");
  EXPECT_THAT(motion.AddArmState(kT0Us + 20'000, kArmJoints, {nan, 0}, {0, 0}), HasSubstr("slide"));
  EXPECT_THAT(motion.AddArmState(kT0Us + 20'000, kArmJoints, {0, 0}, {0, nan}), HasSubstr("turn"));
  EXPECT_THAT(motion.AddArmState(kT0Us + 20'000, {"slide", "other"}, {0, 0}, {0, 0}),
              HasSubstr("turn"));
  EXPECT_NE(motion.AddArmState(kT0Us + 20'000, kArmJoints, {0}, {0, 0}), "");
  EXPECT_NE(motion.AddArmState(kT0Us + 20'000, {}, {}, {}), "");
  EXPECT_EQ(AddPose(10'000, &motion), "");
  EXPECT_NE(AddPose(10'000, &motion), "");
  EXPECT_EQ(AddArm(20'000, &motion), "");  // the good one still comes through
}

TEST(EgoMotionTest, JointsMayComeInAnyOrderAndAmongOthers) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  EXPECT_EQ(motion.AddArmState(kT0Us, {"gripper", "turn", "slide"}, {9, Turn(0), Slide(0)},
                               {9, -0.3, 0.5}),
            "");
  EXPECT_TRUE(motion.At(kT0Us)->X_WC.isApprox(CameraAt(0), 1e-9));
}

TEST(EgoMotionTest, ARigWithoutHandEyeHasItsCameraAtTheHand) {
  RigDescription rig = RigWithArm();
  rig.X_HC.reset();
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(rig);
  AddArm(0, &motion);
  EXPECT_TRUE((motion.At(kT0Us)->X_WC * *RigWithArm().X_HC).isApprox(CameraAt(0), 1e-9));
}

TEST(EgoMotionTest, ANewRigReplacesTheArmAndItsStates) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  AddArm(0, &motion);
  motion.SetRig(RigWithArm());
  EXPECT_TRUE(motion.missing());
  motion.SetRig(RigWithoutArm());
  EXPECT_EQ(motion.source(), Source::kNone);
}

TEST(EgoMotionTest, ARigWhoseArmIsRefusedChangesNothing) {
  EgoMotion motion(Choice::kAuto);
  motion.SetRig(RigWithArm());
  AddArm(0, &motion);
  RigDescription bad = RigWithArm();
  bad.arm->tip_link = "foot";
  EXPECT_THAT([&] { motion.SetRig(bad); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("foot")));
  bad.arm->urdf = "<robot";
  EXPECT_THAT([&] { motion.SetRig(bad); }, ::testing::Throws<std::invalid_argument>());
  EXPECT_FALSE(motion.missing());
  EXPECT_TRUE(motion.At(kT0Us)->X_WC.isApprox(CameraAt(0), 1e-9));

  EgoMotion fixed(Choice::kAuto);
  fixed.SetRig(RigWithoutArm());
  EXPECT_THAT([&] { fixed.SetRig(bad); }, ::testing::Throws<std::invalid_argument>());
  EXPECT_EQ(fixed.source(), Source::kNone);
}

}  // namespace
}  // namespace visavis
