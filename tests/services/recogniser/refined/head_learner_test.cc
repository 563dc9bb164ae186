// HeadLearner: a head is learned beside the frames from the views that it is given.
#include "services/recogniser/refined/head_learner.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/recogniser/background_thread.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr int kMostViews = 4;
constexpr int kLatest = 60;  ///< frames with a track in which a head of so few views is learned

/// Features and a grain that are the same on both sides.
Color SymmetricHead(const Eigen::Vector3f& p_M) {
  return FeaturedHead({std::abs(p_M.x()), p_M.y(), p_M.z()});
}

class HeadLearnerTest : public ::testing::Test {
 protected:
  HeadLearnerTest() : scene_(TestRig()) {}

  HeadLearner Learner(Background* background, int most_views = kMostViews) const {
    const HeadGeometry head{SharedAdultHead().surface, {0, 0, 0}};
    return {RefinerConfig{}, TestRig(), 1.0, head, most_views, background};
  }
  /// A frame with the head turned by @p yaw_deg. The pose given is @p askew_deg off.
  HeadLearner::Learned Show(HeadLearner* learner, double yaw_deg, double askew_deg = 0) {
    const RigidTransform X_CM = TransformFromPhi(PhiOf(0, 0, 1000, 0, yaw_deg, 0));
    if (yaw_deg != shown_deg_) scene_.Show(X_CM, SymmetricHead);
    shown_deg_ = yaw_deg;
    StereoFrame frame;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    const RigidTransform X_MN =
        MakeTransform(ExpRotation({0, askew_deg * M_PI / 180, 0}), Eigen::Vector3d::Zero());
    learner->Add(frame, X_CM * X_MN, {scene_.colors(0), scene_.colors(1)});
    return learner->Step();
  }
  /// Frames until a head is learned, of a head that looks about; @p frames: how many those were.
  HeadLearner::Learned Learn(HeadLearner* learner, int* frames, double askew_deg = 0) {
    for (*frames = 1; *frames < 2 * kLatest; ++*frames) {
      const double yaw_deg = 6 * (*frames / 8 % 4);
      HeadLearner::Learned learned = Show(learner, yaw_deg, askew_deg);
      if (learned.head) return learned;
    }
    return {};
  }

  MeshScene scene_;
  double shown_deg_{NAN};
};

TEST_F(HeadLearnerTest, LearnsAFaceOfManyViewsAndItsFrame) {
  HeadLearner learner = Learner(nullptr);
  int frames;
  const HeadLearner::Learned learned = Learn(&learner, &frames, 3);
  ASSERT_TRUE(learned.head);
  EXPECT_LE(frames, kLatest);
  EXPECT_GT(learned.head->head.face->points.size(), 400u);
  // The poses given were of a frame that was turned by 3 deg.
  const Eigen::Vector3d turned_deg = LogRotation(learned.X_MN.linear()) * (180 / M_PI);
  EXPECT_NEAR(turned_deg.y(), 3, 0.9);
  EXPECT_LT(std::hypot(turned_deg.x(), turned_deg.z()), 1.5);
}

TEST_F(HeadLearnerTest, AThreadBesideTheFramesLearnsTheSameInTheSameFrame) {
  BackgroundThread thread(true);
  HeadLearner at_once = Learner(nullptr), beside = Learner(&thread);
  int frames_at_once, frames_beside;
  const HeadLearner::Learned one = Learn(&at_once, &frames_at_once);
  const HeadLearner::Learned other = Learn(&beside, &frames_beside);
  EXPECT_EQ(frames_at_once, frames_beside);
  ASSERT_TRUE(one.head && other.head);
  EXPECT_EQ(one.X_MN.matrix(), other.X_MN.matrix());
  EXPECT_EQ(one.head->head.face->points, other.head->head.face->points);
  EXPECT_EQ(one.head->head.face->value, other.head->head.face->value);
}

TEST_F(HeadLearnerTest, WhatIsKnownFromAllSidesIsNotLearnedAgain) {
  HeadLearner learner = Learner(nullptr);
  int frames;
  for (int i = 0; i < 4 && Learn(&learner, &frames).head; ++i) ASSERT_LT(i, 3);
  EXPECT_FALSE(Learn(&learner, &frames).head);
}

TEST_F(HeadLearnerTest, OneSideMoreIsLearnedWhenItHasWaitedLong) {
  HeadLearner learner = Learner(nullptr, 20);
  int waited;
  while (Learn(&learner, &waited).head) {
  }
  while (waited < 300 && !Show(&learner, 24).head) ++waited;
  EXPECT_GT(waited, 120);
  EXPECT_LT(waited, 150 + kLatest);
}

TEST_F(HeadLearnerTest, AHeadThatIsForgottenBeforeItWasLearnedNeverComes) {
  HeadLearner learner = Learner(nullptr);
  for (int i = 0; i < 15; ++i) ASSERT_FALSE(Show(&learner, 6 * (i / 8 % 4)).head) << i;
  learner.Forget();
  for (int i = 0; i < 30; ++i) ASSERT_FALSE(learner.Step().head) << i;
}

TEST_F(HeadLearnerTest, ATrackThatIsLostAgainAndAgainGivesNoView) {
  HeadLearner learner = Learner(nullptr);
  for (int i = 0; i < 2 * kLatest; ++i) {
    if (i % 4 == 0) learner.Lose();
    ASSERT_FALSE(Show(&learner, 6 * (i / 8 % 4)).head) << i;
  }
}

TEST_F(HeadLearnerTest, OfNoViewsNothingIsLearned) {
  HeadLearner learner = Learner(nullptr, 0);
  int frames;
  EXPECT_FALSE(Learn(&learner, &frames).head);
}

}  // namespace
}  // namespace visavis
