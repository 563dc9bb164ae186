#include "services/simulator/scenario.h"

#include <gtest/gtest.h>

#include "common/rigs/demo_rig.h"
#include "tests/support/config_refusal.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;

Scenario Make(const ScenarioConfig& config, std::uint64_t seed = 1) {
  return Scenario(config, DemoCameraPose(), seed);
}

ScenarioConfig Named(const std::string& name) {
  ScenarioConfig config;
  config.name = name;
  config.head_phi_mm_deg.clear();
  return config;
}

RigidTransform X_CM(const Scenario& scenario, double t) {
  return scenario.CameraPose(t).inverse() * scenario.HeadPose(t);
}

TEST(ScenarioTest, ShuttleMovesTheCameraAsTheCosineAlongTheWorldsX) {
  ScenarioConfig config = Named("shuttle_x");
  config.period_s = 7;
  const Scenario scenario = Make(config);
  for (double t = 0; t < 20; t += 0.37) {
    const Eigen::Vector3d moved =
        scenario.CameraPose(t).translation() - DemoCameraPose().translation();
    EXPECT_LT((moved - Eigen::Vector3d(0.15 * std::cos(2 * M_PI * t / 7), 0, 0)).norm(), 1e-12);
    EXPECT_EQ(scenario.CameraPose(t).linear(), DemoCameraPose().linear());
    EXPECT_TRUE(scenario.HeadPose(t).isApprox(DemoHeadPose(), 1e-12));
  }
}

TEST(ScenarioTest, OrbitKeepsTheDistanceAndTheHeadsCentreOnTheAxis) {
  ScenarioConfig config = Named("orbit_theta");
  config.period_s = 10;
  config.head_phi_mm_deg = {40, -30, 60, 3, 5, -4};
  const Scenario scenario = Make(config);
  const double distance = Eigen::Vector3d(0.04, -0.03, 1.06).norm();
  for (double t = 0; t < 12; t += 0.31) {
    const Eigen::Vector3d p_CM = X_CM(scenario, t).translation();
    EXPECT_LT((p_CM - Eigen::Vector3d(0, 0, distance)).norm(), 1e-12) << t;
  }
}

TEST(ScenarioTest, OrbitSwingsThetaByTenDegrees) {
  ScenarioConfig config = Named("orbit_theta");
  config.period_s = 20;
  const Scenario scenario = Make(config);
  const auto theta = [&](double t) { return PhiFromTransform(X_CM(scenario, t))[4]; };
  EXPECT_NEAR(std::abs(theta(0)), 10 * kDegree, 1e-9);
  EXPECT_NEAR(theta(5), 0, 1e-9);
  EXPECT_NEAR(theta(10), -theta(0), 1e-9);
}

TEST(ScenarioTest, StaticStaysWhereTheOffsetPutsTheHead) {
  ScenarioConfig config = Named("static");
  config.head_phi_mm_deg = {10, 20, -50, 1, 2, 3};
  const Scenario scenario = Make(config);
  Vector6d expected;
  expected << 0.01, 0.02, 0.95, kDegree, 2 * kDegree, 3 * kDegree;
  for (const double t : {0.0, 3.3, 100.0}) {
    EXPECT_LT((PhiFromTransform(X_CM(scenario, t)) - expected).norm(), 1e-12);
  }
}

TEST(ScenarioTest, MovingHeadStaysWithinItsLimitsAndMovesSmoothly) {
  const ScenarioConfig config = Named("moving_head");
  const Scenario scenario = Make(config);
  Vector6d most = Vector6d::Zero();
  for (double t = 0; t < 60; t += 1.0 / 30) {
    Vector6d phi = PhiFromTransform(X_CM(scenario, t));
    phi[2] -= 1;
    most = most.cwiseMax(phi.cwiseAbs());
    const Vector6d next = PhiFromTransform(X_CM(scenario, t + 1.0 / 30));
    ASSERT_LT((next.head<3>() - PhiFromTransform(X_CM(scenario, t)).head<3>()).norm(), 0.02);
  }
  EXPECT_LE(most.head<3>().maxCoeff(), 0.080 + 1e-9);
  EXPECT_LE(most.tail<3>().maxCoeff(), 15 * kDegree + 1e-9);
  EXPECT_GT(most[0], 0.06);
  EXPECT_GT(most[4], 11 * kDegree);
  EXPECT_EQ(scenario.CameraPose(1.3).matrix(), DemoCameraPose().matrix());
}

TEST(ScenarioTest, MovingHeadMayMoveTheCameraToo) {
  ScenarioConfig config = Named("moving_head");
  config.camera_moves = true;
  EXPECT_NEAR(Make(config).CameraPose(0).translation().x(), 0.15, 1e-12);
}

TEST(ScenarioTest, RandomPosesFillTheSearchSpaceAndHold) {
  ScenarioConfig config = Named("random_poses");
  config.hold_s = 0.5;
  const Scenario scenario = Make(config);
  Vector6d low = Vector6d::Constant(9), high = -low;
  for (int k = 0; k < 200; ++k) {
    const Vector6d phi = PhiFromTransform(X_CM(scenario, 0.5 * k));
    EXPECT_EQ(scenario.HeadPose(0.5 * k).matrix(), scenario.HeadPose(0.5 * k + 0.49).matrix());
    EXPECT_NE(scenario.HeadPose(0.5 * k).matrix(), scenario.HeadPose(0.5 * k + 0.5).matrix());
    low = low.cwiseMin(phi);
    high = high.cwiseMax(phi);
  }
  Vector6d least, most;
  least << -0.2, -0.2, 0.9, Eigen::Vector3d::Constant(-20 * kDegree);
  most << 0.2, 0.2, 1.2, Eigen::Vector3d::Constant(20 * kDegree);
  EXPECT_TRUE((low.array() >= least.array() - 1e-9).all());
  EXPECT_TRUE((high.array() <= most.array() + 1e-9).all());
  EXPECT_TRUE(((high - low).array() > 0.9 * (most - least).array()).all());
  EXPECT_NE(Make(config, 2).HeadPose(0).matrix(), scenario.HeadPose(0).matrix());
}

TEST(ScenarioTest, TheHeadIsAwayBetweenTheTimesGiven) {
  ScenarioConfig config = Named("static");
  EXPECT_TRUE(Make(config).HeadPresent(5));
  config.absent_from_s = 4;
  config.absent_until_s = 6;
  config.return_shift_mm = -80;
  const Scenario scenario = Make(config);
  EXPECT_TRUE(scenario.HeadPresent(3.99));
  EXPECT_FALSE(scenario.HeadPresent(4));
  EXPECT_FALSE(scenario.HeadPresent(5.99));
  EXPECT_TRUE(scenario.HeadPresent(6));
  EXPECT_NEAR(X_CM(scenario, 3).translation().x(), 0, 1e-12);
  EXPECT_NEAR(X_CM(scenario, 7).translation().x(), -0.08, 1e-12);
}

TEST(ScenarioTest, TheHeadWalksOutOfViewAndIn) {
  ScenarioConfig config = Named("static");
  config.absent_from_s = 4;
  config.absent_until_s = 6;
  config.leave_s = 1;
  config.return_shift_mm = 50;
  const Scenario scenario = Make(config);
  const auto x = [&](double t) { return X_CM(scenario, t).translation().x(); };
  EXPECT_NEAR(x(3), 0, 1e-12);
  EXPECT_NEAR(x(4), 1.3, 1e-12);
  EXPECT_NEAR(x(6), 1.3, 1e-12);
  EXPECT_NEAR(x(7), 0.05, 1e-12);
  for (double t = 2.5; t < 8; t += 0.033) EXPECT_LT(std::abs(x(t + 0.033) - x(t)), 0.08);
}

TEST(ScenarioTest, ByDefaultTheHeadStandsALittleOffItsNominalPlace) {
  const RigidTransform X_CM0 = X_CM(Make({}), 15.0 / 4);  // the shuttle's middle
  EXPECT_GT((X_CM0.translation() - Eigen::Vector3d(0, 0, 1)).norm(), 0.005);
  EXPECT_LT((X_CM0.translation() - Eigen::Vector3d(0, 0, 1)).norm(), 0.02);
}

TEST(ScenarioTest, RefusesContradictionsByName) {
  ScenarioConfig config;
  config.head_phi_mm_deg = {1, 2};
  ExpectRefusal([&] { config.ValidateOrThrow(); }, "scenario.head_phi_mm_deg", "2 numbers", "six");
  config = {};
  config.random_min_z_mm = 1300;
  ExpectRefusal([&] { config.ValidateOrThrow(); }, "scenario.random_min_z_mm", "1300",
                "random_max_z_mm");
  config = {};
  config.absent_from_s = 5;
  config.absent_until_s = 5;
  ExpectRefusal([&] { Make(config); }, "scenario.absent_until_s", "5", "later");
}

}  // namespace
}  // namespace visavis
