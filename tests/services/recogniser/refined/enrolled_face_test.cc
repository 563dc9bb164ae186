// The refined estimator with a face that was enrolled: HeadGeometry::face.
#include <gtest/gtest.h>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

const Vector6d kPlace = PhiOf(40, -20, 1000, 4, -8, 5);

double FrozenTime() { return 0; }

/// FeaturedHead's face, learned from poses that are known.
LearnedFace Enrol(MeshScene* scene) {
  PoseRefiner refiner(RefinerConfig{}, SharedAdultHead().surface, SharedAdultHead().mesh,
                      SharedAdultHead().face);
  FaceTexture texture(SharedAdultHead().face);
  for (const Vector6d& aside : {PhiOf(0, 0, 0, 0, 0, 0), PhiOf(0, 0, 0, 0, 12, 0),
                                PhiOf(0, 0, 0, 0, -12, 0), PhiOf(0, 0, 0, 0, 0, 10)}) {
    const RigidTransform X_CM = TransformFromPhi(kPlace + aside);
    const StereoView& view = scene->Show(X_CM, FeaturedHead);
    for (const Band band : {kFineBand, kCoarseBand}) {
      for (std::size_t eye = 0; eye < 2; ++eye)
        texture.Learn(band, refiner.Sample(view, eye, X_CM, band, texture));
    }
  }
  return texture.Learned();
}

class EnrolledFaceTest : public ::testing::Test {
 protected:
  EnrolledFaceTest()
      : scene_(TestRig()),
        head_{SharedAdultHead().surface, {0, 0, 0}, Enrol(&scene_)},
        settings_(RecogniserConfig{}.RefinedSettings()),
        estimator_(settings_, head_, TestRig()) {}

  const Estimate& See(const Vector6d& phi, const Painter& painter) {
    truth_ = TransformFromPhi(phi);
    scene_.Show(truth_, painter);
    return SeeAgain();
  }
  const Estimate& SeeAgain() { return estimator_.Process(Frame(), {}, &timer_); }
  StereoFrame Frame() {
    StereoFrame frame;
    frame.utime_us = 33'333 * frames_++;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    return frame;
  }
  void ShowEnrolled(int frames) {
    See(kPlace, FeaturedHead);
    for (int i = 1; i < frames; ++i) ASSERT_EQ(SeeAgain().status, TrackStatus::kTracking);
  }
  /// Until the stranger's is the face that is tracked.
  void MeetStranger() {
    See(kPlace, StrangerHead);
    for (int i = 1; i < 20; ++i) SeeAgain();
    ASSERT_EQ(SeeAgain().status, TrackStatus::kTracking);
    ASSERT_FALSE(estimator_.knows_enrolled());
  }

  MeshScene scene_;
  const HeadGeometry head_;
  const RefinedSettings settings_;
  RefinedEstimator estimator_;
  StageTimer timer_{&FrozenTime};
  RigidTransform truth_;
  std::int64_t frames_{0};
};

TEST_F(EnrolledFaceTest, IsTrackedFromTheFirstFrameAndNeitherItsLooksNorItsFrameMove) {
  for (int i = 0; i < 20; ++i) {
    const Vector6d phi = kPlace + i * PhiOf(1, -0.5, 1, 0.2, 0.5, -0.3);
    const Estimate& estimate = See(phi, FeaturedHead);
    ASSERT_EQ(estimate.status, TrackStatus::kTracking) << i;
    const RecognitionError error = ComputeRecognitionError(truth_, *estimate.X_CM);
    EXPECT_LT(error.position.norm(), 0.0015) << i;
    EXPECT_LT(error.total_angle, 0.02) << i;
  }
  EXPECT_TRUE(estimator_.knows_enrolled());
  const LearnedFace now = estimator_.texture().Learned();
  EXPECT_EQ(now.points, head_.face->points);
  EXPECT_EQ(now.normals, head_.face->normals);
  EXPECT_EQ(now.value, head_.face->value);
}

TEST_F(EnrolledFaceTest, AStrangerIsTrackedOnceSeenLongEnoughAndIsAFaceOfItsOwn) {
  ShowEnrolled(5);
  const int strange_frames = settings_.refined.evidence.strange_frames;
  scene_.Show(TransformFromPhi(kPlace), StrangerHead);
  for (int i = 1; i < strange_frames; ++i) {
    EXPECT_EQ(SeeAgain().status, TrackStatus::kLost) << i;
    EXPECT_TRUE(estimator_.knows_enrolled()) << i;
  }
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(SeeAgain().status, TrackStatus::kTracking) << i;
    EXPECT_FALSE(estimator_.knows_enrolled()) << i;
  }
  EXPECT_TRUE(estimator_.texture().learned());
}

TEST_F(EnrolledFaceTest, AStrangerDoesNotGetTheMeasuredShapeOfTheEnrolled) {
  HeadGeometry measured = head_;
  measured.is_measured = true;
  RefinedEstimator estimator(settings_, measured, TestRig());
  scene_.Show(TransformFromPhi(kPlace), StrangerHead);
  for (int i = 0; i < 60; ++i) estimator.Process(Frame(), {}, &timer_);
  const auto [count, learned] = estimator.learned_head();
  ASSERT_GT(count, 0);
  ASSERT_NE(learned, nullptr);
  EXPECT_FALSE(learned->is_measured);
}

TEST_F(EnrolledFaceTest, AnEnrolledFaceThatComesBackAfterAStrangerIsRecognised) {
  MeetStranger();
  const int most = settings_.refined.evidence.strange_frames + 5;
  See(kPlace, FeaturedHead);
  for (int i = 1; i < most && !estimator_.knows_enrolled(); ++i) SeeAgain();
  EXPECT_TRUE(estimator_.knows_enrolled());
  EXPECT_EQ(estimator_.texture().Learned().value, head_.face->value);
  const Estimate& estimate = See(kPlace, FeaturedHead);
  EXPECT_EQ(estimate.status, TrackStatus::kTracking);
  EXPECT_LT(ComputeRecognitionError(truth_, *estimate.X_CM).position.norm(), 0.0015);
}

TEST_F(EnrolledFaceTest, ResetBringsTheEnrolledFaceBack) {
  MeetStranger();
  estimator_.Reset();
  EXPECT_TRUE(estimator_.knows_enrolled());
  EXPECT_EQ(estimator_.texture().Learned().points, head_.face->points);
  EXPECT_EQ(See(kPlace, FeaturedHead).status, TrackStatus::kTracking);
}

TEST_F(EnrolledFaceTest, TheFrameDoesNotCreepThoughTheGenericModelWouldPutItElsewhere) {
  HeadGeometry shifted = head_;
  for (Eigen::Vector3f& p : shifted.face->points) p.x() += 0.004f;
  RefinedEstimator estimator(settings_, shifted, TestRig());
  scene_.Show(TransformFromPhi(kPlace), FeaturedHead);
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 40; ++i) {
    places.push_back(estimator.Process(Frame(), {}, &timer_).X_CM->translation());
  }
  EXPECT_GT(std::abs(places.back().x() - kPlace.x()), 0.0005);  // the face's frame, not the model's
  EXPECT_LT((places[39] - places[20]).norm(), 0.0002);
  EXPECT_EQ(estimator.texture().points().points, shifted.face->points);
}

TEST_F(EnrolledFaceTest, LookingForTheEnrolledFaceAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "mallocs cannot be counted under a sanitizer";
  ShowEnrolled(10);
  std::int64_t before = NumMallocs();
  for (int i = 0; i < 10; ++i) SeeAgain();
  EXPECT_EQ(NumMallocs(), before);
  MeetStranger();
  for (int i = 0; i < 40; ++i) SeeAgain();  // until the stranger's head was learned
  before = NumMallocs();
  for (int i = 0; i < 10; ++i) SeeAgain();
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
