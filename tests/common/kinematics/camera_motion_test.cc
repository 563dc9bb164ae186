#include "common/kinematics/camera_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "common/core/random.h"
#include "common/kinematics/inverse_kinematics.h"
#include "tests/common/kinematics/demo_paths.h"

namespace visavis {
namespace {

std::vector<std::string> NamesOf(const Arm& arm) {
  std::vector<std::string> names;
  for (const ArmJoint& joint : arm.joints()) names.push_back(joint.name);
  return names;
}

/// The demo arm on the paper's shuttle with T = 1 s, the fastest of its motions.
struct CameraMotionTest : ::testing::Test {
  Eigen::VectorXd Q(double t) {
    return ik.Solve(hand_eye.HandPoseFor(ShuttleX(t)), DemoPosture()).q;
  }
  Eigen::VectorXd Qdot(double t) { return (Q(t + 1e-4) - Q(t - 1e-4)) / 2e-4; }

  /// Half a second of joint states, their velocities with noise.
  ArmCameraMotion Filled(int period_us, double velocity_noise = 0) {
    auto& states = states_of[period_us];
    for (int us = 0; states.size() * period_us <= 500'000; us += period_us) {
      states.push_back({Q(us * 1e-6), Qdot(us * 1e-6)});
    }
    ArmCameraMotion motion(hand_eye);
    for (int i = 0; i * period_us <= 500'000; ++i) {
      Eigen::VectorXd qdot = states[i].qdot;
      for (double& v : qdot) v += velocity_noise * random.Normal();
      motion.Add(i * period_us, names, states[i].q, qdot);
    }
    return motion;
  }

  struct State {
    Eigen::VectorXd q, qdot;
  };
  std::map<int, std::vector<State>> states_of;  // by period: inverse kinematics takes its time
  HandEye hand_eye{LoadDemoHandEye()};
  std::vector<std::string> names{NamesOf(hand_eye.arm())};
  InverseKinematics ik{hand_eye.arm(), DemoPosture()};
  Random random{1};
};

TEST_F(CameraMotionTest, ArmGivesPoseAndTwistOfTheCameraBetweenItsSamples) {
  const ArmCameraMotion motion = Filled(10'000);
  for (int us = 3'000; us < 500'000; us += 31'000) {
    const auto state = motion.At(us);
    ASSERT_TRUE(state);
    const double t = us * 1e-6;
    EXPECT_LT((state->X_WC.matrix() - ShuttleX(t).matrix()).norm(), 1e-6);
    const Eigen::Vector3d v(-0.15 * 2 * M_PI * std::sin(2 * M_PI * t), 0, 0);
    EXPECT_TRUE(state->has_twist);
    EXPECT_LT((state->twist.v_WC - v).norm(), 1e-4);
    EXPECT_LT(state->twist.w_WC.norm(), 1e-4);
    EXPECT_FALSE(state->extrapolated);
    EXPECT_EQ(state->age_us, us % 10'000);
  }
}

TEST_F(CameraMotionTest, BothSourcesAreReadAlikeThroughTheInterface) {
  ArmCameraMotion arm = Filled(10'000);
  PoseCameraMotion poses;
  for (int us = 0; us <= 500'000; us += 10'000) poses.Add(us, ShuttleX(us * 1e-6));
  for (const CameraMotion* motion :
       {static_cast<const CameraMotion*>(&arm), static_cast<const CameraMotion*>(&poses)}) {
    EXPECT_EQ(motion->newest_us(), 500'000);
    EXPECT_EQ(motion->counts().accepted, 51);
    EXPECT_LT((motion->At(250'000)->X_WC.matrix() - ShuttleX(0.25).matrix()).norm(), 1e-9);
    EXPECT_TRUE(motion->At(505'000)->extrapolated);
    EXPECT_FALSE(motion->At(511'000));
  }
  arm.Clear();
  poses.Clear();
  EXPECT_FALSE(arm.At(250'000));
  EXPECT_FALSE(poses.At(250'000));
}

TEST_F(CameraMotionTest, ExtrapolationOverOnePeriodErrsByHalfTheAccelerationTimesTimeSquared) {
  const ArmCameraMotion motion = Filled(10'000);  // ends at t = T/2, where |x''| is largest
  const auto state = motion.At(510'000);
  ASSERT_TRUE(state);
  const double error = (state->X_WC.translation() - ShuttleX(0.51).translation()).norm();
  EXPECT_NEAR(error, 0.5 * 0.01 * 0.01 * 0.15 * 4 * M_PI * M_PI, 2e-5);  // 0.3 mm
}

/// Largest error of the camera's place in mm, by the history's cubic and by straight lines.
struct Errors {
  double cubic_mm, linear_mm;
};
Errors WorstErrors(CameraMotionTest* test, int period_us, double velocity_noise) {
  const ArmCameraMotion motion = test->Filled(period_us, velocity_noise);
  Errors worst{0, 0};
  for (int us = period_us / 2; us < 500'000; us += period_us) {
    const Eigen::Vector3d truth = ShuttleX(us * 1e-6).translation();
    const Eigen::VectorXd q_0 = motion.joints().At(us - period_us / 2)->q,
                          q_1 = motion.joints().At(us + period_us / 2)->q;
    const Eigen::VectorXd q = (q_0 + q_1) / 2;
    const auto error_mm = [&](const RigidTransform& X) {
      return (X.translation() - truth).norm() * 1e3;
    };
    worst.cubic_mm = std::max(worst.cubic_mm, error_mm(motion.At(us)->X_WC));
    worst.linear_mm = std::max(worst.linear_mm, error_mm(test->hand_eye.CameraPose(q)));
  }
  return worst;
}

// The figures on which JointHistory's choice and HistoryOptions::max_gap_us rest.
TEST_F(CameraMotionTest, CubicIsFiftyTimesBetterThanStraightLinesAndBearsNoisyVelocities) {
  for (const int period_us : {10'000, 50'000, 100'000}) {
    const Errors clean = WorstErrors(this, period_us, 0);
    const Errors noisy = WorstErrors(this, period_us, 0.01);
    std::printf(
        "shuttle T=1 s, arm at %3d Hz: cubic %.5f mm, with 0.01 rad/s noise %.3f mm, "
        "linear %.3f mm\n",
        1'000'000 / period_us, clean.cubic_mm, noisy.cubic_mm, clean.linear_mm);
    EXPECT_LT(clean.cubic_mm, clean.linear_mm / 50);
    EXPECT_LT(noisy.cubic_mm, 0.1 + 0.25 * clean.linear_mm);
  }
}

}  // namespace
}  // namespace visavis
