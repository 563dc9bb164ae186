#include "services/recogniser/refined/refined_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/adult_head.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

const Vector6d kPlace = PhiOf(40, -20, 1000, 4, -8, 5);

double FrozenTime() { return 0; }

/// FeaturedHead, covered from @p x_m in M on.
Painter CoveredFrom(float x_m) {
  return [x_m](const Eigen::Vector3f& p_M) {
    return p_M.x() > x_m ? Color{120, 90, 200} : FeaturedHead(p_M);
  };
}

/// A painted head before an estimator with the default settings.
SearchSpace Shifted(SearchSpace space, const Eigen::Vector3d& by_m) {
  space.min.head<3>() += by_m;
  space.max.head<3>() += by_m;
  return space;
}

class RefinedEstimatorTest : public ::testing::Test {
 protected:
  RefinedEstimatorTest()
      : scene_(TestRig()),
        estimator_(RecogniserConfig{}.RefinedSettings(), HeadGeometry{}, TestRig()) {
    timer_.Restart();
  }

  enum class Eyes { kBoth, kRight, kLeft, kSwapped };

  const Estimate& See(Eyes eyes = Eyes::kBoth, const CameraStep& step = {}) {
    StereoFrame frame;
    frame.utime_us = 33'333 * frames_++;
    if (eyes != Eyes::kLeft) frame.right = scene_.picture(eyes == Eyes::kSwapped ? 1 : 0);
    if (eyes != Eyes::kRight) frame.left = scene_.picture(eyes == Eyes::kSwapped ? 0 : 1);
    return estimator_.Process(frame, step, &timer_);
  }
  const Estimate& SeeHeadAt(const Vector6d& phi, const CameraStep& step = {},
                            const Painter& painter = FeaturedHead) {
    truth_ = TransformFromPhi(phi);
    scene_.Show(truth_, painter);
    return See(Eyes::kBoth, step);
  }
  void ExpectTracked(const Estimate& estimate, double mm, double deg) const {
    EXPECT_EQ(estimate.status, TrackStatus::kTracking);
    ASSERT_TRUE(estimate.X_CM);
    const auto error = ComputeRecognitionError(truth_, *estimate.X_CM);
    EXPECT_LT(1e3 * error.position.norm(), mm);
    EXPECT_LT(error.total_angle * 180 / M_PI, deg);
  }

  MeshScene scene_;
  RefinedEstimator estimator_;
  StageTimer timer_{&FrozenTime};
  RigidTransform truth_;
  std::int64_t frames_{0};
};

TEST_F(RefinedEstimatorTest, FindsAHeadOfUnknownPoseInTheFirstFrame) {
  ExpectTracked(SeeHeadAt(kPlace), 4, 2);
}

TEST_F(RefinedEstimatorTest, FollowsAHeadThatMoves) {
  SeeHeadAt(kPlace);
  for (int i = 1; i <= 20; ++i) {
    const double s = static_cast<double>(i);
    ExpectTracked(SeeHeadAt(kPlace + s * PhiOf(2, -1, 3, 0.2, 0.3, -0.2)), 4, 2);
  }
}

TEST_F(RefinedEstimatorTest, TheFeedforwardCarriesTheHeadOverALargeStepOfTheCamera) {
  SeeHeadAt(kPlace);
  CameraStep step;
  step.known = true;
  step.dt_s = 0.033;
  step.X_C2C1 = MakeTransform(ExpRotation({0, 0.02, 0}), Eigen::Vector3d(-0.04, 0.01, 0.02));
  const Vector6d next = PhiFromTransform(step.X_C2C1 * TransformFromPhi(kPlace));
  const Estimate& estimate = SeeHeadAt(next, step);
  ExpectTracked(estimate, 4, 2);
  EXPECT_EQ(estimate.feedforward, FeedforwardMode::kExact);
  EXPECT_LT(estimate.evaluations, 200);  // tracked, not searched for
}

TEST_F(RefinedEstimatorTest, AHeadThatJumpsIsFoundWithinTenFrames) {
  for (int i = 0; i < 5; ++i) SeeHeadAt(kPlace);
  const Vector6d elsewhere = PhiOf(-110, 50, 1120, -10, 12, -8);
  int lost = 0;
  while (lost < 10 && SeeHeadAt(elsewhere).status != TrackStatus::kTracking) ++lost;
  ExpectTracked(SeeHeadAt(elsewhere), 5, 2.5);
}

TEST_F(RefinedEstimatorTest, AnEmptyRoomIsNeverTracked) {
  truth_ = TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0));  // out of sight
  scene_.Show(truth_, FeaturedHead);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(See().status, TrackStatus::kSearching);
}

TEST_F(RefinedEstimatorTest, InGreyAHeadIsFoundAndFollowedAndAnEmptyRoomIsNot) {
  scene_.ShowGray(TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0)), FeaturedHead);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(See().status, TrackStatus::kSearching);
  for (int i = 0; i < 12; ++i) {
    truth_ = TransformFromPhi(kPlace + i * PhiOf(3, -1, 3, 0.3, 0.4, -0.3));
    scene_.ShowGray(truth_, FeaturedHead);
    const Estimate& estimate = See();
    if (i > 1) ExpectTracked(estimate, 5, 3);
  }
}

TEST_F(RefinedEstimatorTest, OneCameraMayBeGrey) {
  truth_ = TransformFromPhi(kPlace);
  MeshScene gray(TestRig());
  gray.ShowGray(truth_, FeaturedHead);
  scene_.Show(truth_, FeaturedHead);
  StereoFrame frame;
  frame.right = scene_.picture(0);
  frame.left = gray.picture(1);
  for (int i = 0; i < 3; ++i) estimator_.Process(frame, {}, &timer_);
  ExpectTracked(estimator_.Process(frame, {}, &timer_), 5, 3);
}

TEST_F(RefinedEstimatorTest, CamerasMayChangeBetweenColourAndGrey) {
  for (int i = 0; i < 5; ++i) SeeHeadAt(kPlace);
  scene_.ShowGray(TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0)), FeaturedHead);
  See();
  ColorModel levels;
  levels.StartFrom(scene_.picture(0));
  EXPECT_EQ(estimator_.colors()[0].table(), levels.table());
  truth_ = TransformFromPhi(PhiOf(-110, 50, 1120, -10, 12, -8));
  scene_.ShowGray(truth_, FeaturedHead);
  for (int i = 0; i < 3; ++i) See();
  ExpectTracked(See(), 5, 3);
}

TEST_F(RefinedEstimatorTest, AHeadThatLeavesIsLostAtOnceAndTrackedWhenItComesBack) {
  for (int i = 0; i < 5; ++i) SeeHeadAt(kPlace);
  scene_.Show(TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0)), FeaturedHead);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(See().status, TrackStatus::kLost);
  int lost = 0;
  while (lost < 10 && SeeHeadAt(kPlace).status != TrackStatus::kTracking) ++lost;
  ExpectTracked(SeeHeadAt(kPlace), 5, 2.5);
}

TEST_F(RefinedEstimatorTest, AFaceHalfCoveredIsTrackedAndSaidToBeLessSure) {
  for (int i = 0; i < 10; ++i) SeeHeadAt(kPlace);
  const Matrix6d free = *See().covariance;
  const Estimate& covered = SeeHeadAt(kPlace, {}, CoveredFrom(0.005f));
  ExpectTracked(covered, 3, 1.5);
  EXPECT_GT(std::sqrt((*covered.covariance)(2, 2)), 2 * std::sqrt(free(2, 2)));
}

TEST_F(RefinedEstimatorTest, AFaceUncoveredWhereItWasLostIsTrackedAtOnceWithoutASearch) {
  for (int i = 0; i < 10; ++i) SeeHeadAt(kPlace);
  const Painter covered = [](const Eigen::Vector3f&) { return kSceneWall; };
  for (int i = 0; i < 5; ++i) EXPECT_EQ(SeeHeadAt(kPlace, {}, covered).status, TrackStatus::kLost);
  const Estimate& estimate = SeeHeadAt(kPlace);
  ExpectTracked(estimate, 4, 2);
  EXPECT_EQ(estimate.evaluations, 0);
}

// What does not fit is excused by something before the face only where the face was seen last.
TEST_F(RefinedEstimatorTest, AHalfCoveredFaceIsTakenUpWhereItWasLostAndElsewhereOnceItIsFree) {
  const Vector6d elsewhere = kPlace + PhiOf(-150, 20, 20, 0, 10, 5);
  const auto lose = [&] {
    for (int i = 0; i < 10; ++i) SeeHeadAt(kPlace);
    scene_.Show(TransformFromPhi(PhiOf(3000, 0, 1000, 0, 0, 0)), FeaturedHead);
    ASSERT_EQ(See().status, TrackStatus::kLost);
  };
  const Painter covered = CoveredFrom(-0.005f);
  lose();
  EXPECT_EQ(SeeHeadAt(kPlace, {}, covered).status, TrackStatus::kTracking);
  lose();
  for (int i = 0; i < 5; ++i)
    EXPECT_NE(SeeHeadAt(elsewhere, {}, covered).status, TrackStatus::kTracking) << i;
  ExpectTracked(SeeHeadAt(elsewhere), 4, 2);
}

TEST_F(RefinedEstimatorTest, SwappedEyesAreNeverTracked) {
  scene_.Show(TransformFromPhi(kPlace), FeaturedHead);
  for (int i = 0; i < 4; ++i) EXPECT_NE(See(Eyes::kSwapped).status, TrackStatus::kTracking);
}

TEST_F(RefinedEstimatorTest, OneEyeGoesOnWhereBothWere) {
  for (int i = 0; i < 10; ++i) SeeHeadAt(kPlace);
  for (const Eyes eye : {Eyes::kRight, Eyes::kLeft}) ExpectTracked(See(eye), 12, 2.5);
  ExpectTracked(See(), 4, 2);
}

TEST_F(RefinedEstimatorTest, OneEyeAloneIsLostAfterAWhileAndFoundAgainByBoth) {
  for (int i = 0; i < 5; ++i) SeeHeadAt(kPlace);
  const int frames = EvidenceConfig{}.one_eye_frames;
  for (int i = 0; i < frames; ++i) EXPECT_EQ(See(Eyes::kRight).status, TrackStatus::kTracking);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(See(Eyes::kRight).status, TrackStatus::kLost);
  int lost = 0;
  while (lost < 5 && See().status != TrackStatus::kTracking) ++lost;
  ExpectTracked(See(), 4, 2);
}

TEST_F(RefinedEstimatorTest, AHeadIsLearnedWhileItIsTrackedAndForgottenByReset) {
  int frames = 0;
  while (estimator_.learned_head().second == nullptr && frames++ < 80) {
    SeeHeadAt(kPlace);
    ExpectTracked(See(), 4, 2);
  }
  ASSERT_NE(estimator_.learned_head().second, nullptr);
  EXPECT_EQ(estimator_.learned_head().first, 1);
  EXPECT_TRUE(estimator_.learned_head().second->face);
  for (int i = 0; i < 10; ++i) ExpectTracked(See(), 4, 2);
  estimator_.Reset();
  EXPECT_EQ(estimator_.learned_head().second, nullptr);
  SeeHeadAt(kPlace);
  ExpectTracked(See(), 4, 2);
}

TEST_F(RefinedEstimatorTest, ATrackedFrameAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "mallocs cannot be counted under a sanitizer";
  for (int i = 0; i < 80; ++i) SeeHeadAt(kPlace);
  ASSERT_NE(estimator_.learned_head().second, nullptr);  // else it is still being learned
  const std::int64_t before = NumMallocs();
  for (int i = 0; i < 10; ++i) See();
  EXPECT_EQ(NumMallocs(), before);
  ExpectTracked(See(), 4, 2);
}

TEST_F(RefinedEstimatorTest, ResetForgetsTheHeadAndTheSameFramesGiveTheSamePoses) {
  std::vector<Eigen::Matrix4d> first;
  for (int i = 0; i < 4; ++i) first.push_back(SeeHeadAt(kPlace).X_CM->matrix());
  RefinedEstimator again(RecogniserConfig{}.RefinedSettings(), HeadGeometry{}, TestRig());
  StereoFrame frame;
  frame.right = scene_.picture(0);
  frame.left = scene_.picture(1);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(again.Process(frame, {}, &timer_).X_CM->matrix(), first[static_cast<std::size_t>(i)]);
  }
  estimator_.Reset();
  EXPECT_GT(See().evaluations, 500);  // searched for anew
}

TEST_F(RefinedEstimatorTest, PosesAreToldFromTheHeadsOwnOrigin) {
  HeadGeometry head;
  head.p_MR_m = {0.01, -0.03, 0.02};
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.space = Shifted(settings.space, head.p_MR_m);  // the space is one of reported poses
  RefinedEstimator shifted(settings, head, TestRig());
  SeeHeadAt(kPlace);
  StereoFrame frame;
  frame.right = scene_.picture(0);
  frame.left = scene_.picture(1);
  const Estimate& plain = See();
  shifted.Process(frame, {}, &timer_);
  const Estimate& estimate = shifted.Process(frame, {}, &timer_);
  const RigidTransform X_MR = MakeTransform(Eigen::Matrix3d::Identity(), head.p_MR_m);
  EXPECT_TRUE((*plain.X_CM * X_MR).isApprox(*estimate.X_CM, 1e-9));
  // u.(dp + dw x r) = u.dp + dw.(r x u)
  const Eigen::Vector3d r = plain.X_CM->linear() * head.p_MR_m, u(0.6, -0.48, 0.64);
  Vector6d with_lever;
  with_lever << u, r.cross(u);
  const double variance = u.dot(estimate.covariance->block<3, 3>(0, 0) * u);
  EXPECT_NEAR(variance, with_lever.dot(*plain.covariance * with_lever), 1e-9 * variance);
}

TEST_F(RefinedEstimatorTest, AStartIsTheHeadsOwnOriginsToo) {
  HeadGeometry head;
  head.p_MR_m = {0.01, -0.03, 0.02};
  const RigidTransform X_MR = MakeTransform(Eigen::Matrix3d::Identity(), head.p_MR_m);
  SeeHeadAt(kPlace);
  StereoFrame frame;
  frame.right = scene_.picture(0);
  frame.left = scene_.picture(1);
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.start_X_CM = truth_;
  RefinedEstimator plain(settings, HeadGeometry{}, TestRig());
  settings.start_X_CM = truth_ * X_MR;
  settings.space = Shifted(settings.space, head.p_MR_m);
  RefinedEstimator shifted(settings, head, TestRig());
  const RigidTransform X_CM = *plain.Process(frame, {}, &timer_).X_CM;
  EXPECT_TRUE((X_CM * X_MR).isApprox(*shifted.Process(frame, {}, &timer_).X_CM, 1e-9));
}

TEST_F(RefinedEstimatorTest, ATableOfTheAdultTracksAsTheAdultDoes) {
  const HeadSurface& adult = TheAdult().surface;
  const HeadGeometry head{HeadSurface(HeadShape{}, TableOf(adult, 5)), {0, 0, 0}};
  RefinedEstimator tabulated(RecogniserConfig{}.RefinedSettings(), head, TestRig());
  SeeHeadAt(kPlace);
  StereoFrame frame;
  frame.right = scene_.picture(0);
  frame.left = scene_.picture(1);
  for (int i = 0; i < 3; ++i) ExpectTracked(tabulated.Process(frame, {}, &timer_), 4, 2);
}

TEST_F(RefinedEstimatorTest, TheCovarianceIsSymmetricAndDepthTheWeakestDirection) {
  const Estimate& estimate = SeeHeadAt(kPlace);
  ASSERT_TRUE(estimate.covariance);
  const auto& covariance = *estimate.covariance;
  EXPECT_TRUE(covariance.isApprox(covariance.transpose(), 1e-9));
  EXPECT_GT(covariance(2, 2), covariance(0, 0));
  EXPECT_GT(covariance(2, 2), covariance(1, 1));
  EXPECT_GT(covariance.diagonal().minCoeff(), 0);
}

}  // namespace
}  // namespace visavis
