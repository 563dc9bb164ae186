#include "services/recogniser/published_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/services/recogniser/published_settings.h"
#include "tests/support/config_refusal.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/simd_targets.h"

namespace visavis {
namespace {

// Head and pictures at 640x480 px.
class PublishedEstimatorTest : public ::testing::Test {
 protected:
  const StereoRig rig_ = TestRig();
  StereoScene scene_{TestHead(), rig_};
  PublishedEstimator::Settings settings_ = PublishedTestSettings();
  const Vector6d phi_ = PhiOf(40, -30, 1020, 6, -8, 5);
  const RigidTransform X_CM_ = TransformFromPhi(phi_);
};

// One still pair, an unknown pose. A binary GA may converge beside the head, so the fittest of some
// seeds is held; F of nearest pixels is flat along z, where a pixel of disparity is 9 mm.
TEST_F(PublishedEstimatorTest, FromAnUnknownPoseTheFittestOfSomeSeedsIsTheHead) {
  settings_.published.generations_per_frame = 300;
  for (const Vector6d& phi : {phi_, PhiOf(-80, 50, 1120, -10, 12, -4)}) {
    const RigidTransform X_CM = TransformFromPhi(phi);
    const StereoFrame frame = scene_.Paint(X_CM);
    double fittest = 0;
    RigidTransform X_CM_fittest = RigidTransform::Identity();
    for (std::uint64_t seed = 0; seed < 7; ++seed) {
      settings_.seed = seed;
      EstimatorRun run(settings_, rig_);
      const Estimate& estimate = run.Process(frame);
      if (estimate.fitness.total < fittest) continue;
      fittest = estimate.fitness.total;
      X_CM_fittest = *estimate.X_CM;
    }
    const RecognitionError error = ComputeRecognitionError(X_CM, X_CM_fittest);
    EXPECT_LT(error.position.head<2>().norm(), 0.004);
    EXPECT_LT(std::abs(error.position.z()), 0.02);
    EXPECT_LT(error.total_angle * 180 / M_PI, 4);
  }
}

TEST_F(PublishedEstimatorTest, AStartPoseIsRefinedInTheFirstFrames) {
  StartAt(phi_, &settings_);
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  const Estimate* estimate = nullptr;
  for (int i = 0; i < 20; ++i) estimate = &run.Process(frame);
  EXPECT_LT(PositionErrorMm(*estimate, X_CM_), 15);
  EXPECT_LT(AngleErrorDeg(*estimate, X_CM_), 5);
  EXPECT_EQ(estimate->status, TrackStatus::kTracking);
}

TEST_F(PublishedEstimatorTest, TheStartPoseCentresTheSpaceWhereItRecentres) {
  const Vector6d outside = PhiOf(320, 0, 1000, 0, 0, 0);
  StartAt(outside, &settings_);
  settings_.start.spread_mm = 5;
  for (const bool recentre : {false, true}) {
    settings_.recentre = recentre;
    EstimatorRun run(settings_, rig_);
    const Estimate& estimate = run.Process(scene_.Paint(outside));
    if (recentre) {
      EXPECT_LT(PositionErrorMm(estimate, TransformFromPhi(outside)), 40);
    } else {
      EXPECT_LE(estimate.X_CM->translation().x(), 0.2 + 1e-12);
    }
  }
}

TEST_F(PublishedEstimatorTest, GrayImagesTrackWithoutColor) {
  StartAt(phi_, &settings_);
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  const OwnedImage right = GrayImage(*frame.right), left = GrayImage(*frame.left);
  const Estimate* estimate = nullptr;
  for (int i = 0; i < 20; ++i) estimate = &run.Process({0, right.view, left.view});
  EXPECT_EQ(estimate->fitness.color, 0);
  EXPECT_EQ(estimate->status, TrackStatus::kTracking);
  EXPECT_LT(PositionErrorMm(*estimate, X_CM_), 25);
  EXPECT_LT(AngleErrorDeg(*estimate, X_CM_), 8);
}

TEST_F(PublishedEstimatorTest, EitherCameraAloneGoesOn) {
  StartAt(phi_, &settings_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  for (const StereoFrame& half :
       {StereoFrame{0, frame.right, std::nullopt}, StereoFrame{0, std::nullopt, frame.left}}) {
    EstimatorRun run(settings_, rig_);
    const Estimate* estimate = nullptr;
    for (int i = 0; i < 20; ++i) estimate = &run.Process(half);
    EXPECT_EQ(estimate->status, TrackStatus::kTracking);
    EXPECT_LT(PositionErrorMm(*estimate, X_CM_), 60);  // one eye sees depth by size alone
    EXPECT_LT(AngleErrorDeg(*estimate, X_CM_), 8);
    // Back to two: well within the frames that one camera may be away.
    for (int i = 0; i < 30; ++i) estimate = &run.Process(frame);
    EXPECT_LT(PositionErrorMm(*estimate, X_CM_), 20);
  }
}

// The space keeps the model inside both images: at their borders F compares the picture with the
// white that lies outside, and a black picture then looks like a head.
TEST_F(PublishedEstimatorTest, APictureWithoutAHeadIsNeverTracked) {
  settings_.space.min[0] = settings_.space.min[1] = -0.1;
  settings_.space.max[0] = settings_.space.max[1] = 0.1;
  Random random(1);
  const OwnedImage noise = NoiseImage(640, 480, &random), wall = FlatImage(640, 480, 200, 205, 210),
                   black = FlatImage(640, 480, 0, 0, 0), skin = FlatImage(640, 480, 224, 172, 140);
  for (const OwnedImage* picture : {&noise, &wall, &black, &skin}) {
    int tracked = 0;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      settings_.seed = seed;
      EstimatorRun run(settings_, rig_);
      for (int i = 0; i < 60; ++i) {
        tracked += run.Process({0, picture->view, picture->view}, AtRest()).status ==
                   TrackStatus::kTracking;
      }
    }
    EXPECT_EQ(tracked, 0);
  }
}

TEST_F(PublishedEstimatorTest, AHeadThatLeavesIsLostAndFoundAgainElsewhere) {
  settings_.published.generations_per_frame = 10;
  StartAt(phi_, &settings_);
  EstimatorRun run(settings_, rig_);
  const StereoFrame there = scene_.Paint(X_CM_);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(run.Process(there, AtRest()).status, TrackStatus::kTracking);  // a known pose
  }
  const OwnedImage wall = FlatImage(640, 480, 200, 205, 210);
  const StereoFrame away{0, wall.view, wall.view};
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(run.Process(away, AtRest()).status, TrackStatus::kLost);
  }
  const RigidTransform X_CM = TransformFromPhi(PhiOf(-120, 60, 1000, 0, 0, 0));
  const StereoFrame back = scene_.Paint(X_CM);
  const Estimate* estimate = nullptr;
  for (int i = 0; i < 60; ++i) estimate = &run.Process(back, AtRest());
  EXPECT_EQ(estimate->status, TrackStatus::kTracking);
  EXPECT_LT(PositionErrorMm(*estimate, X_CM), 40);
}

TEST_F(PublishedEstimatorTest, ResetIsSearchingWithANewPopulation) {
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  settings_.published.generations_per_frame = 10;
  for (int i = 0; i < 40; ++i) run.Process(frame, AtRest());
  const double spread_before =
      (run.estimator.population()[0].phi - run.estimator.population()[20].phi).norm();
  run.estimator.Reset();
  const Estimate& estimate = run.Process(frame, AtRest());
  EXPECT_EQ(estimate.status, TrackStatus::kSearching);
  double left = 0;
  for (const Individual& individual : run.estimator.population()) left += individual.phi[0] < 0;
  EXPECT_GT(left, 15);  // everywhere again
  EXPECT_LT(left, 45);
  EXPECT_GT((run.estimator.population()[0].phi - run.estimator.population()[20].phi).norm(),
            spread_before);
}

TEST_F(PublishedEstimatorTest, ANewSearchSpaceBoundsTheEstimate) {
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  run.Process(frame);
  const SearchSpace beside{PhiOf(100, -200, 900, -20, -20, -20), PhiOf(200, 200, 1200, 20, 20, 20)};
  run.estimator.SetSearchSpace(beside);
  for (int i = 0; i < 10; ++i) {
    EXPECT_TRUE(beside.Contains(PhiFromTransform(*run.Process(frame).X_CM)));
  }
}

TEST_F(PublishedEstimatorTest, CountsGenerationsAndEvaluations) {
  settings_.published.generations_per_frame = 4;
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  for (int i = 1; i <= 3; ++i) {
    const Estimate& estimate = run.Process(frame);
    EXPECT_EQ(estimate.generations, 4);
    EXPECT_EQ(estimate.evaluations, 60 + 3 * 45);  // the elite of 15 is known after the first
    EXPECT_EQ(run.estimator.total_generations(), 4 * i);
  }
}

TEST_F(PublishedEstimatorTest, TellsWhichFeedforwardCarriedThePopulation) {
  const StereoFrame frame = scene_.Paint(X_CM_);
  EstimatorRun run(settings_, rig_);
  EXPECT_EQ(run.Process(frame).feedforward, FeedforwardMode::kNone);  // no step known
  for (const FeedforwardMode mode :
       {FeedforwardMode::kJacobian, FeedforwardMode::kNone, FeedforwardMode::kExact}) {
    run.estimator.SetFeedforward(mode);
    EXPECT_EQ(run.Process(frame, AtRest()).feedforward, mode);
  }
}

TEST_F(PublishedEstimatorTest, ThePopulationIsTheEvaluatedOneFittestFirst) {
  EstimatorRun run(settings_, rig_);
  const Estimate& estimate = run.Process(scene_.Paint(X_CM_));
  const std::vector<Individual>& population = run.estimator.population();
  ASSERT_EQ(population.size(), 60u);
  EXPECT_TRUE(std::is_sorted(population.begin(), population.end(),
                             [](const auto& a, const auto& b) { return a.fitness > b.fitness; }));
  EXPECT_TRUE(std::all_of(population.begin(), population.end(),
                          [](const auto& individual) { return individual.evaluated; }));
  EXPECT_EQ(population[0].fitness, estimate.fitness.total);
  EXPECT_TRUE(TransformFromPhi(population[0].phi).isApprox(*estimate.X_CM));
}

std::vector<Vector6d> PosesOfARun(const PublishedEstimator::Settings& settings,
                                  const StereoRig& rig, StereoScene* scene) {
  EstimatorRun run(settings, rig);
  std::vector<Vector6d> poses;
  CameraStep step = AtRest();
  step.X_C2C1 = MakeTransform(ExpRotation({0.001, 0.002, 0}), Eigen::Vector3d(0.004, 0, 0.001));
  RigidTransform X_CM = TransformFromPhi(PhiOf(-40, 20, 1050, 3, -5, 8));
  for (int i = 0; i < 15; ++i) {
    poses.push_back(PhiFromTransform(*run.Process(scene->Paint(X_CM), step).X_CM));
    X_CM = step.X_C2C1 * X_CM;
  }
  return poses;
}

TEST_F(PublishedEstimatorTest, TheSameSeedGivesTheSamePosesToTheLastBitOnEverySimdTarget) {
  const StereoRig rig = SmallRig();
  StereoScene scene(TestHead(), rig);
  const std::vector<Vector6d> poses = PosesOfARun(settings_, rig, &scene);
  EXPECT_EQ(PosesOfARun(settings_, rig, &scene), poses);
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    EXPECT_EQ(PosesOfARun(settings_, rig, &scene), poses) << target;
  }
  SelectSimdTarget("auto");
  settings_.seed = 2;
  EXPECT_NE(PosesOfARun(settings_, rig, &scene), poses);
}

TEST_F(PublishedEstimatorTest, AllocatesNothingAfterTheFirstFrame) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  EstimatorRun run(settings_, rig_);
  const StereoFrame frame = scene_.Paint(X_CM_);
  const OwnedImage gray = GrayImage(*frame.right), wall = FlatImage(640, 480, 200, 205, 210);
  run.Process(frame);
  const std::int64_t before = NumMallocs();
  for (const FeedforwardMode mode :
       {FeedforwardMode::kExact, FeedforwardMode::kJacobian, FeedforwardMode::kNone}) {
    run.estimator.SetFeedforward(mode);
    for (int i = 0; i < 20; ++i) run.Process(frame, AtRest());
  }
  for (int i = 0; i < 40; ++i) run.Process({0, wall.view, wall.view}, AtRest());
  run.Process({0, gray.view, std::nullopt}, AtRest());
  run.estimator.Reset();
  run.Process(frame, AtRest());
  EXPECT_EQ(NumMallocs(), before);
}

TEST_F(PublishedEstimatorTest, BeatsRandomSearchWithAsManyEvaluations) {
  settings_.published.generations_per_frame = 60;
  const StereoFrame frame = scene_.Paint(X_CM_);
  PackedMap right(640, 480), left(640, 480);
  right.Build(*frame.right, settings_.published.color);
  left.Build(*frame.left, settings_.published.color);
  const StereoFitness fitness(HeadModel(TestHead()), rig_, {});
  int wins = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    settings_.seed = seed;
    EstimatorRun run(settings_, rig_);
    const Estimate& estimate = run.Process(frame);
    Random random(100 + seed);
    double best = 0;
    for (int i = 0; i < estimate.evaluations; ++i) {
      Vector6d phi;
      for (int k = 0; k < 6; ++k)
        phi[k] = random.Uniform(settings_.space.min[k], settings_.space.max[k]);
      best = std::max(best, fitness.Evaluate({&right, &left}, phi).total);
    }
    wins += estimate.fitness.total > best;
  }
  EXPECT_GE(wins, 9);
}

TEST(StartConfigTest, AStartPoseHasSixFiniteNumbersOrNone) {
  StartConfig start;
  EXPECT_NO_THROW(start.ValidateOrThrow("start."));
  start.phi_mm_deg = {1, 2, 1000, 4, 5, 6};
  EXPECT_NO_THROW(start.ValidateOrThrow("start."));
  start.phi_mm_deg = {1, 2, 1000, 4, 5};
  ExpectRefusal([&] { start.ValidateOrThrow("start."); }, "start.phi_mm_deg", "5 numbers",
                "must be six, or empty");
  start.phi_mm_deg = {1, 2, std::nan(""), 4, 5, 6};
  ExpectRefusal([&] { start.ValidateOrThrow("start."); }, "start.phi_mm_deg", "not finite",
                "must be six numbers");
}

}  // namespace
}  // namespace visavis
