#include "services/evaluate/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/run_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kDeg = M_PI / 180;
constexpr auto kTracking = RunLog::kTracking;
constexpr auto kSearching = RunLog::kSearching;

Vector6d Error(double x_mm, double y_mm, double z_mm, double Phi_deg = 0, double theta_deg = 0,
               double psi_deg = 0) {
  Vector6d error;
  error << 1e-3 * x_mm, 1e-3 * y_mm, 1e-3 * z_mm, kDeg * Phi_deg, kDeg * theta_deg, kDeg * psi_deg;
  return error;
}

class EvaluationTest : public ::testing::Test {
 protected:
  /// Evaluates what has been written so far.
  Evaluation Evaluated(const std::optional<HeadOffset>& offset = std::nullopt) {
    log_.Close();
    return Evaluate(ReadRunRecord(path_, ""), offset);
  }
  HeadOffset Fitted() {
    log_.Close();
    return FitHeadOffset(ReadRunRecord(path_, ""));
  }
  /// Truth at rest at @p X_CM for @p n frames of 10 Hz from @p first on; the first @p num_wrong
  /// estimates err by 100 mm.
  void Rest(int first, int n, const RigidTransform& X_CM, int num_wrong) {
    for (int i = 0; i < n; ++i) {
      log_.Frame(100'000 * (first + i), kTracking, X_CM, Error(i < num_wrong ? 100 : 0, 0, 0));
    }
  }

  const TemporaryFolder folder_;
  const std::string path_{folder_ / "run.lcm"};
  RunLog log_{path_};
  const RigidTransform X_CM_{Pose(0.1, -0.02, 1, 0.1, -0.2, 0.15)};
};

TEST_F(EvaluationTest, ErrorsAreThoseOfTrackingFramesFromTwoSecondsOn) {
  log_.Frame(0, kTracking, X_CM_, Error(500, 0, 0));
  log_.Frame(1'999'999, kTracking, X_CM_, Error(500, 0, 0));
  log_.Frame(2'000'000, kTracking, X_CM_, Error(1, 0, 0, 1, 0, 0));
  log_.Frame(2'100'000, kSearching, X_CM_, Error(500, 0, 0));
  log_.Frame(2'200'000, RunLog::kLost, X_CM_, Error(500, 0, 0));
  log_.Frame(2'300'000, kTracking, X_CM_, Error(2, 3, 0, 3, 0, 0));
  log_.Frame(2'400'000, kTracking, X_CM_, Error(-3, 0, -4, -4, 0, 0));
  const Evaluation e = Evaluated();
  EXPECT_EQ(e.num_frames, 7);
  EXPECT_EQ(e.num_frames_with_truth, 7);
  EXPECT_THAT(e.num_by_status, ElementsAre(1, 5, 1));
  EXPECT_EQ(e.raw.num_frames, 3);
  const Statistics x = *e.raw.errors.position_m[0];
  EXPECT_NEAR(x.rmse, 1e-3 * std::sqrt((1 + 4 + 9) / 3.0), 1e-12);
  EXPECT_NEAR(x.mean, 2e-3, 1e-12);
  EXPECT_NEAR(x.max, 3e-3, 1e-12);
  EXPECT_NEAR(x.bias, 0, 1e-12);
  EXPECT_NEAR(e.raw.errors.position_m[1]->bias, 1e-3, 1e-12);
  EXPECT_NEAR(e.raw.errors.position_m[2]->bias, -4e-3 / 3, 1e-12);
  const Statistics norm = *e.raw.errors.position_norm_m;
  EXPECT_NEAR(norm.rmse, 1e-3 * std::sqrt((1 + 13 + 25) / 3.0), 1e-12);
  EXPECT_NEAR(norm.mean, 1e-3 * (1 + std::sqrt(13.0) + 5) / 3, 1e-12);
  EXPECT_NEAR(norm.max, 5e-3, 1e-12);
  EXPECT_NEAR(norm.bias, 1e-3 * std::hypot(0, 1, 4 / 3.0), 1e-12);
  const Statistics Phi = *e.raw.errors.angle_rad[0];
  EXPECT_NEAR(Phi.rmse, kDeg * std::sqrt((1 + 9 + 16) / 3.0), 1e-12);
  EXPECT_NEAR(Phi.bias, 0, 1e-12);
  EXPECT_NEAR(e.raw.errors.angle_rad[1]->max, 0, 1e-12);
  EXPECT_NEAR(e.raw.errors.total_angle_rad->mean, kDeg * 8 / 3, 1e-9);
}

TEST_F(EvaluationTest, SharesAreOfAllFramesWithTruth) {
  log_.Frame(0, kTracking, X_CM_, Error(15, 0, 0));                // within, though not settled
  log_.Frame(100'000, kTracking, X_CM_, Error(0, 15.1, 0));        // neither
  log_.Frame(200'000, kTracking, X_CM_, Error(0, 0, 0, 4.9));      // within
  log_.Frame(300'000, kTracking, X_CM_, Error(0, 0, 0, 5.1));      // neither
  log_.Frame(400'000, kTracking, X_CM_, Error(0, 0, 30.1));        // false
  log_.Frame(500'000, kTracking, X_CM_, Error(0, 0, 0, 0, 10.1));  // false
  log_.Frame(600'000, kSearching, X_CM_, Error(0, 0, 0));          // good, but not TRACKING
  log_.Frame(700'000, kSearching, X_CM_, Error(900, 0, 0));        // a guess, not false
  log_.Truth(800'000, X_CM_);
  log_.Estimate(800'000, kTracking, std::nullopt);  // TRACKING nothing: false
  log_.Estimate(900'000, kTracking, X_CM_);         // unknown truth: in no share
  const Evaluation e = Evaluated();
  EXPECT_EQ(e.num_frames, 10);
  EXPECT_EQ(e.num_frames_with_truth, 9);
  EXPECT_DOUBLE_EQ(*e.share_tracking, 7.0 / 9);
  EXPECT_DOUBLE_EQ(*e.raw.share_within, 2.0 / 9);
  EXPECT_DOUBLE_EQ(*e.raw.share_false_tracking, 3.0 / 9);
  EXPECT_FALSE(e.aligned);
}

TEST_F(EvaluationTest, FirstLockIsTheFirstGoodTrackingFrame) {
  log_.Frame(5'000'000, kSearching, X_CM_);
  log_.Frame(5'100'000, kTracking, X_CM_, Error(16, 0, 0));
  log_.Frame(5'200'000, kTracking, X_CM_, Error(14, 0, 0));
  EXPECT_DOUBLE_EQ(*Evaluated().first_lock_s, 0.2);
}

TEST_F(EvaluationTest, TenFramesAfterAJumpAreLeftOutAndCountAsRecovery) {
  const RigidTransform X_a = Pose(0, 0, 1), X_b = Pose(0.05, 0, 1), X_c = Pose(0.05, 0, 1, 0.2);
  Rest(0, 30, X_a, 0);
  Rest(30, 20, X_b, 3);   // recovered by its fourth frame
  Rest(50, 15, X_c, 15);  // not recovered within its 15 frames
  Rest(65, 15, X_a, 0);   // right at once
  const Evaluation e = Evaluated();
  EXPECT_THAT(e.recovery_frames, ElementsAre(3, 15, 0));
  EXPECT_EQ(e.num_not_recovered, 1);
  // 10 settled frames, and what is left behind the first ten after each jump.
  EXPECT_EQ(e.raw.num_frames, 10 + 10 + 5 + 5);
  EXPECT_DOUBLE_EQ(e.raw.errors.position_m[0]->bias, 0.1 * 5 / 30);
  EXPECT_DOUBLE_EQ(*e.raw.share_within, (30 + 17 + 0 + 15) / 80.0);
  EXPECT_DOUBLE_EQ(*e.raw.share_false_tracking, (3 + 15) / 80.0);
}

TEST_F(EvaluationTest, WhatTheCameraPoseExplainsIsNoJump) {
  for (int i = 0; i < 30; ++i) {
    const RigidTransform X_WC = Pose(0.05 * i, 0, 0);
    log_.CameraPose(100'000 * i, X_WC);
    log_.Frame(100'000 * i, kTracking, X_WC.inverse() * X_CM_);
  }
  const Evaluation e = Evaluated();
  EXPECT_THAT(e.recovery_frames, IsEmpty());
  EXPECT_EQ(e.raw.num_frames, 10);
}

TEST_F(EvaluationTest, TheTruthsOwnWorldPoseExplainsTheCamerasMotionToo) {
  for (int i = 0; i < 30; ++i) {
    const RigidTransform X_WC = Pose(0.05 * i, 0, 0), X_CM = X_WC.inverse() * X_CM_;
    log_.Truth(100'000 * i, X_CM, X_WC);
    log_.Estimate(100'000 * i, kTracking, X_CM);
  }
  EXPECT_THAT(Evaluated().recovery_frames, IsEmpty());
}

TEST_F(EvaluationTest, WithoutCameraPosesTheSameMotionIsJumps) {
  for (int i = 0; i < 30; ++i) log_.Frame(100'000 * i, kTracking, Pose(0.05 * i, 0, 1));
  EXPECT_EQ(Evaluated().recovery_frames.size(), 29u);
}

TEST_F(EvaluationTest, AHeadThatIsAwayHasNoTruthButIsCounted) {
  log_.Truth(0, std::nullopt);
  log_.Estimate(0, kTracking, X_CM_);
  log_.Truth(100'000, std::nullopt);
  log_.Estimate(100'000, RunLog::kLost, std::nullopt);
  log_.Frame(200'000, kTracking, X_CM_);
  const Evaluation e = Evaluated();
  EXPECT_EQ(e.num_frames_with_truth, 1);
  EXPECT_EQ(e.num_no_head, 2);
  EXPECT_EQ(e.num_tracking_no_head, 1);
  EXPECT_THAT(e.recovery_frames, ElementsAre(0));  // it came back
}

TEST_F(EvaluationTest, WithoutTruthAllIsUnknown) {
  log_.Estimate(0, kTracking, X_CM_);
  const Evaluation e = Evaluated();
  EXPECT_EQ(e.num_frames, 1);
  EXPECT_EQ(e.num_frames_with_truth, 0);
  EXPECT_FALSE(e.share_tracking);
  EXPECT_FALSE(e.first_lock_s);
  EXPECT_FALSE(e.raw.share_within);
  EXPECT_FALSE(e.raw.errors.position_norm_m);
}

TEST_F(EvaluationTest, EachSessionSettlesAnew) {
  Rest(100, 25, X_CM_, 25);  // never right
  Rest(0, 25, X_CM_, 20);    // a jump back by 10 s: right once it has settled
  const Evaluation e = Evaluated();
  EXPECT_EQ(e.raw.num_frames, 10);
  EXPECT_DOUBLE_EQ(e.raw.errors.position_m[0]->bias, 0.05);
  EXPECT_FALSE(e.first_lock_s);  // of the first session
  EXPECT_THAT(e.recovery_frames, IsEmpty());
}

TEST_F(EvaluationTest, AConstantHeadOffsetIsFoundAndRemoved) {
  HeadOffset offset;
  offset.X_TM = Pose(0.001, 0.02, -0.004, 0.02, -0.03, 0.05);
  const RigidTransform views[] = {Pose(0, 0, 1), Pose(0.05, 0, 1, 0, 0.3), Pose(0, 0.05, 1.1, 0.3)};
  for (int i = 0; i < 60; ++i) {
    const RigidTransform& X_CT = views[i / 20];
    log_.Truth(100'000 * i, X_CT);
    // A third of the frames is wrong by 80 mm.
    log_.Estimate(100'000 * i, kTracking,
                  (i % 3 == 0 ? Pose(0.08, 0, 0) * X_CT : X_CT) * offset.X_TM);
  }
  const HeadOffset fitted = Fitted();
  EXPECT_LT((fitted.X_TM.matrix() - offset.X_TM.matrix()).norm(), 1e-9);
  EXPECT_EQ(fitted.num_frames, 30);  // without ten frames after the start and each jump
  const Evaluation e = Evaluated(offset);
  EXPECT_NEAR(e.raw.errors.position_m[1]->bias, -0.02, 0.01);
  EXPECT_DOUBLE_EQ(*e.raw.share_within, 0);
  EXPECT_FALSE(e.offset->X_TM.matrix().hasNaN());
  EXPECT_DOUBLE_EQ(*e.aligned->share_within, 40 / 60.0);
  EXPECT_DOUBLE_EQ(*e.aligned->share_false_tracking, 20 / 60.0);
  EXPECT_NEAR(e.aligned->errors.total_angle_rad->max, 0, 1e-7);
  EXPECT_NEAR(*e.first_lock_s, 0.1, 1e-12);  // judged on the aligned error
  EXPECT_THAT(e.recovery_frames, ElementsAre(0, 0));
}

TEST_F(EvaluationTest, AFitNeedsTrackingFrames) {
  for (int i = 0; i < 20; ++i) log_.Frame(100'000 * i, i < 4 ? kTracking : kSearching, X_CM_);
  EXPECT_THROW(Fitted(), std::invalid_argument);
}

TEST_F(EvaluationTest, AShortRunIsFittedOnAllItsTrackingFrames) {
  for (int i = 0; i < 6; ++i) log_.Frame(100'000 * i, kTracking, X_CM_, Error(0, -20, 0));
  EXPECT_THAT(Fitted().num_frames, 6);
  EXPECT_NEAR((X_CM_.linear() * Fitted().X_TM.translation()).y(), 0.02, 1e-9);
}

TEST_F(EvaluationTest, LatenciesComeFromTheTiming) {
  log_.Estimate(0, kTracking, X_CM_);
  log_.Latency(0, 3);
  log_.Latency(0, std::nan(""));
  log_.Latency(0, 1);
  EXPECT_THAT(Evaluated().latencies_ms, ElementsAre(3, 1));
}

TEST_F(EvaluationTest, ALogWithoutHeadPoseIsRefused) {
  log_.Truth(0, X_CM_);
  log_.Close();
  EXPECT_THAT([&] { ReadRunRecord(path_, ""); },
              ::testing::ThrowsMessage<std::invalid_argument>(path_ + ": must hold HEAD_POSE"));
}

}  // namespace
}  // namespace visavis
