#include "services/simulator/arm_trajectory.h"

#include <gtest/gtest.h>

#include "common/rigs/demo_rig.h"
#include "services/simulator/scenario.h"

namespace visavis {
namespace {

HandEye DemoHandEye() {
  const RigDescription rig = DemoRig();
  return {Arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link), rig.arm->X_WB, *rig.X_HC};
}

class ArmTrajectoryTest : public ::testing::TestWithParam<const char*> {
 protected:
  static ScenarioConfig Config() {
    ScenarioConfig config;
    config.name = GetParam();
    config.period_s = 7;
    return config;
  }

  const HandEye hand_eye_ = DemoHandEye();
  const Scenario scenario_{Config(), DemoCameraPose(), 1};
  ArmTrajectory trajectory_{hand_eye_,
                            Eigen::Map<const Eigen::VectorXd>(kDemoArmPosture.data(),
                                                              Eigen::Index{kDemoArmPosture.size()}),
                            [this](double t) { return scenario_.CameraPose(t); }};
};
INSTANTIATE_TEST_SUITE_P(Scenarios, ArmTrajectoryTest,
                         ::testing::Values("shuttle_x", "orbit_theta", "static"));

TEST_P(ArmTrajectoryTest, CarriesTheCameraAlongTheScenariosPath) {
  for (double t = 0; t < 8; t += 0.0371) {
    const RigidTransform wanted = scenario_.CameraPose(t);
    const RigidTransform is = hand_eye_.CameraPose(trajectory_.At(t).q);
    // Exact at the knots, cubic between them.
    EXPECT_LT((is.translation() - wanted.translation()).norm(), 2e-4) << t;
    EXPECT_LT(LogRotation(is.linear().transpose() * wanted.linear()).norm(), 2e-4) << t;
  }
}

TEST_P(ArmTrajectoryTest, VelocitiesAreTheDerivativesOfThePositions) {
  for (double t = 0.1; t < 3; t += 0.113) {
    const double h = 1e-5;
    const JointVector difference = (trajectory_.At(t + h).q - trajectory_.At(t - h).q) / (2 * h);
    EXPECT_LT((difference - trajectory_.At(t).qdot).cwiseAbs().maxCoeff(), 1e-6) << t;
  }
}

TEST_P(ArmTrajectoryTest, StaysWithinTheArmsLimitsOfPositionAndSpeed) {
  for (double t = 0; t < 7; t += 0.05) {
    const auto sample = trajectory_.At(t);
    EXPECT_EQ(hand_eye_.arm().FindJointBeyondLimits(sample.q), -1);
    for (int j = 0; j < hand_eye_.arm().num_joints(); ++j) {
      EXPECT_LT(std::abs(sample.qdot[j]),
                hand_eye_.arm().joints()[static_cast<std::size_t>(j)].max_speed);
    }
  }
}

TEST(ArmTrajectoryFailureTest, SaysWhenAndWhyTheArmCannotFollow) {
  ScenarioConfig config;
  config.amplitude_mm = 1000;
  const Scenario scenario(config, DemoCameraPose(), 1);
  ArmTrajectory trajectory(DemoHandEye(),
                           Eigen::Map<const Eigen::VectorXd>(kDemoArmPosture.data(),
                                                             Eigen::Index{kDemoArmPosture.size()}),
                           [&](double t) { return scenario.CameraPose(t); });
  try {
    trajectory.At(0);
    FAIL() << "a metre aside was reached";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("the arm cannot follow the scenario at"),
              std::string::npos);
  }
}

}  // namespace
}  // namespace visavis
