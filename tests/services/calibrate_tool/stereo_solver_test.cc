#include "services/calibrate_tool/stereo_solver.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/board_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

StereoSettings Settings() {
  StereoSettings settings;
  settings.width = settings.left_width = 640;
  settings.height = settings.left_height = 480;
  return settings;
}

std::vector<StereoView> Views(const BoardScene& scene, double noise_px, std::uint64_t seed) {
  std::vector<StereoView> views;
  for (const ArmView& view : SeeAll(scene, noise_px, seed)) views.push_back(view.view);
  return views;
}

double AngleRad(const RigidTransform& a, const RigidTransform& b) {
  return LogRotation(a.linear().transpose() * b.linear()).norm();
}

TEST(StereoSolverTest, WithoutNoiseItFindsTheRigExactly) {
  const BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 15, 1);
  const auto found = CalibrateStereo(scene.board, Views(scene, 0, 1), Settings());
  EXPECT_NEAR(found.rig.right.fx, scene.rig.right.fx, 1e-4);
  EXPECT_NEAR(found.rig.right.cy, scene.rig.right.cy, 1e-4);
  EXPECT_NEAR(found.rig.left.fy, scene.rig.left.fy, 1e-4);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(found.rig.left.distortion[i], scene.rig.left.distortion[i], 1e-4) << i;
  EXPECT_LT((found.rig.X_CL.translation() - scene.rig.X_CL.translation()).norm(), 1e-7);
  EXPECT_LT(AngleRad(found.rig.X_CL, scene.rig.X_CL), 1e-6);
  EXPECT_LT(found.rms_px, 1e-6);
  for (std::size_t i = 0; i < scene.X_CT.size(); ++i)
    EXPECT_LT((found.X_CT[i].translation() - scene.X_CT[i].translation()).norm(), 1e-6);
}

// Errors over their standard deviations have a mean square of 1; over 20 trials of 3 + 3 numbers,
// which depend on each other, within a factor of 2.
TEST(StereoSolverTest, ItsStandardDeviationsAreThoseOfItsErrors) {
  double p_sum = 0, r_sum = 0, f_sum = 0;
  const int num_trials = 12;
  for (int trial = 0; trial < num_trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 12, 100 + seed);
    const auto found = CalibrateStereo(scene.board, Views(scene, 0.2, seed), Settings());
    EXPECT_NEAR(found.rms_px, 0.2 * std::sqrt(2), 0.02);
    const Eigen::Vector3d p = found.rig.X_CL.translation() - scene.rig.X_CL.translation();
    const Eigen::Vector3d r =
        LogRotation(scene.rig.X_CL.linear().transpose() * found.rig.X_CL.linear());
    p_sum += p.cwiseQuotient(found.p_CL_sigma_m).squaredNorm() / (3 * num_trials);
    r_sum += r.cwiseQuotient(found.r_CL_sigma_rad).squaredNorm() / (3 * num_trials);
    const double f = (found.rig.right.fx - scene.rig.right.fx) / found.right_sigma.fx;
    f_sum += f * f / num_trials;
  }
  for (const double sum : {p_sum, r_sum, f_sum}) {
    EXPECT_GT(sum, 0.4);
    EXPECT_LT(sum, 2);
  }
}

TEST(StereoSolverTest, OneBadViewAndWrongCornersDoLittleHarm) {
  const BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 20, 3);
  std::vector<StereoView> views = Views(scene, 0.1, 3);
  const auto clean = CalibrateStereo(scene.board, views, Settings());
  for (std::size_t i = 0; i < views.size(); i += 2) views[i].right.pixels[3].x() += 25;
  const auto found = CalibrateStereo(scene.board, views, Settings());
  EXPECT_LT((found.rig.X_CL.translation() - clean.rig.X_CL.translation()).norm(), 3e-4);
  EXPECT_LT(std::abs(found.rig.right.fx - clean.rig.right.fx), 1);
  EXPECT_GT(found.right_rms_px[0], 3 * found.right_rms_px[1]);  // and the views are told
}

TEST(StereoSolverTest, CoefficientsThatAreFixedStay0) {
  const BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 10, 4);
  StereoSettings settings = Settings();
  settings.distortion = DistortionModel::kRadial;
  const auto found = CalibrateStereo(scene.board, Views(scene, 0.1, 4), settings);
  EXPECT_NE(found.rig.right.distortion[0], 0);
  EXPECT_GT(found.right_sigma.distortion[1], 0);
  for (const std::size_t i : {2, 3, 4}) {
    EXPECT_EQ(found.rig.left.distortion[i], 0);
    EXPECT_EQ(found.left_sigma.distortion[i], 0);
  }
  settings.distortion = DistortionModel::kNone;
  const auto none = CalibrateStereo(scene.board, Views(scene, 0.1, 4), settings);
  EXPECT_FALSE(none.rig.right.has_distortion());
  EXPECT_GT(none.rms_px, 2 * found.rms_px);  // the lens distorts
}

TEST(StereoSolverTest, AViewOfOneEyeServesThatEye) {
  const BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 14, 5);
  std::vector<StereoView> views = Views(scene, 0, 5);
  views[2].right = {};
  views[3].left = {};
  const auto found = CalibrateStereo(scene.board, views, Settings());
  EXPECT_LT((found.rig.X_CL.translation() - scene.rig.X_CL.translation()).norm(), 1e-7);
  EXPECT_LT((found.X_CT[2].translation() - scene.X_CT[2].translation()).norm(), 1e-6);
}

TEST(StereoSolverTest, ViewsThatDoNotDetermineItAreRefused) {
  BoardScene scene = MakeBoardScene(SmallBoard(9, 7), 8, 6);
  std::vector<StereoView> views = Views(scene, 0.1, 6);
  std::vector<StereoView> apart = views;
  for (std::size_t i = 0; i < apart.size(); ++i) (i % 2 ? apart[i].right : apart[i].left) = {};
  EXPECT_THAT([&] { CalibrateStereo(scene.board, apart, Settings()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("board in both images")));
  views.resize(3);
  EXPECT_THAT([&] { CalibrateStereo(scene.board, views, Settings()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("views: 3 show enough of the board")));
}

}  // namespace
}  // namespace visavis
