#include "services/calibrate_tool/hand_eye_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/board_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double AngleRad(const RigidTransform& a, const RigidTransform& b) {
  return LogRotation(a.linear().transpose() * b.linear()).norm();
}

/// Turns and moves each hand by normal noise: what the arm does not know.
void Shake(std::vector<ArmView>* views, double sigma_m, double sigma_rad, std::uint64_t seed) {
  Random random(seed);
  const auto noise = [&](double sigma) {
    return Eigen::Vector3d(sigma * random.Normal(), sigma * random.Normal(),
                           sigma * random.Normal());
  };
  for (ArmView& view : *views) {
    const Eigen::Vector3d r = noise(sigma_rad);
    view.X_BH = view.X_BH * MakeTransform(ExpRotation(r), noise(sigma_m));
  }
}

TEST(HandEyeSolverTest, WithoutNoiseItFindsHandAndBoardExactly) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 10, 1);
  const auto found = CalibrateHandEye(scene.board, scene.rig, SeeAll(scene, 0, 1), {});
  EXPECT_LT((found.X_HC.translation() - scene.X_HC.translation()).norm(), 1e-7);
  EXPECT_LT(AngleRad(found.X_HC, scene.X_HC), 1e-6);
  EXPECT_LT((found.X_BT.translation() - scene.X_BT.translation()).norm(), 1e-6);
  EXPECT_LT(found.residual_rms_m, 1e-6);
  EXPECT_LT(found.rms_px, 1e-6);
}

// As for the stereo rig: within a factor of 2.
TEST(HandEyeSolverTest, ItsStandardDeviationsAreThoseOfItsErrors) {
  const HandEyeSettings settings;
  double p_sum = 0, r_sum = 0;
  const int num_trials = 15;
  for (int trial = 0; trial < num_trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 8, 200 + seed);
    auto views = SeeAll(scene, 0.2, seed);
    Shake(&views, settings.arm_sigma_m, settings.arm_sigma_rad, 300 + seed);
    const auto found = CalibrateHandEye(scene.board, scene.rig, views, settings);
    const Eigen::Vector3d p = found.X_HC.translation() - scene.X_HC.translation();
    const Eigen::Vector3d r = LogRotation(scene.X_HC.linear().transpose() * found.X_HC.linear());
    p_sum += p.cwiseQuotient(found.p_HC_sigma_m).squaredNorm() / (3 * num_trials);
    r_sum += r.cwiseQuotient(found.r_HC_sigma_rad).squaredNorm() / (3 * num_trials);
  }
  for (const double sum : {p_sum, r_sum}) {
    EXPECT_GT(sum, 0.5);
    EXPECT_LT(sum, 2);
  }
}

// One number of the rig is off by its standard deviation; the answer is off by what is told.
TEST(HandEyeSolverTest, TheRigsOwnUncertaintyIsInItsStandardDeviations) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 10, 5);
  const auto views = SeeAll(scene, 0, 5);
  StereoRig off = scene.rig;
  off.right.cx += 0.5;
  HandEyeSettings settings;
  const auto without = CalibrateHandEye(scene.board, off, views, settings);
  settings.rig_uncertainty.emplace();
  settings.rig_uncertainty->right.cx = 0.5;
  const auto with = CalibrateHandEye(scene.board, off, views, settings);
  const Eigen::Vector3d p = with.X_HC.translation() - scene.X_HC.translation();
  const Eigen::Vector3d r = LogRotation(scene.X_HC.linear().transpose() * with.X_HC.linear());
  EXPECT_EQ(with.X_HC.matrix(), without.X_HC.matrix());
  const auto added = [](const Eigen::Vector3d& larger, const Eigen::Vector3d& smaller) {
    return std::sqrt(larger.squaredNorm() - smaller.squaredNorm());
  };
  EXPECT_NEAR(added(with.p_HC_sigma_m, without.p_HC_sigma_m), p.norm(), 0.2 * p.norm());
  EXPECT_NEAR(added(with.r_HC_sigma_rad, without.r_HC_sigma_rad), r.norm(), 0.2 * r.norm());
  EXPECT_GT(p.norm(), 1e-5);
}

TEST(HandEyeSolverTest, AViewWhoseArmWasWrongStandsOut) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 12, 2);
  auto views = SeeAll(scene, 0.1, 2);
  views[4].X_BH.translation().x() += 0.02;
  const auto found = CalibrateHandEye(scene.board, scene.rig, views, {});
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i == 4) continue;
    EXPECT_LT(found.residual_m[i], 0.5 * found.residual_m[4]) << i;
  }
  EXPECT_GT(found.residual_m[4], 0.008);
}

TEST(HandEyeSolverTest, AViewThatShowsTooLittleIsLeftOut) {
  const BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 8, 3);
  auto views = SeeAll(scene, 0, 3);
  views[1].view.right = {};  // the left eye alone serves
  views[2].view.right = views[2].view.left = {};
  const auto found = CalibrateHandEye(scene.board, scene.rig, views, {});
  EXPECT_TRUE(std::isnan(found.residual_m[2]));
  EXPECT_LT(found.residual_m[1], 1e-6);
  EXPECT_LT((found.X_HC.translation() - scene.X_HC.translation()).norm(), 1e-7);
}

TEST(HandEyeSolverTest, HandsThatTurnAboutOneAxisOnlyAreRefused) {
  BoardScene scene = MakeBoardScene(SmallBoard(8, 6), 8, 4);
  auto views = SeeAll(scene, 0, 4);
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].X_BH = MakeTransform(ExpRotation({0, 0, 0.2 * static_cast<double>(i)}),
                                  Eigen::Vector3d(0.1 * static_cast<double>(i), 0, 0));
  }
  EXPECT_THAT([&] { CalibrateHandEye(scene.board, scene.rig, views, {}); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("about the second of its axes: must be at least")));
  views.resize(3);
  EXPECT_THAT([&] { CalibrateHandEye(scene.board, scene.rig, views, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("views: 3 with board and arm")));
}

}  // namespace
}  // namespace visavis
