#include "services/recogniser/recogniser_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "tests/services/recogniser/sliding_arm.h"

namespace visavis {
namespace {

Estimate AnEstimate() {
  Estimate estimate;
  estimate.status = TrackStatus::kTracking;
  estimate.X_CM = TransformFromPhi(PhiOf(10, -20, 1030, 4, -5, 6));
  estimate.covariance.emplace();
  for (int i = 0; i < 36; ++i) (*estimate.covariance)(i / 6, i % 6) = 0.5 * i;
  estimate.fitness = {1.5, 0.4, 0.8, 0.3};
  estimate.generations = 3;
  estimate.evaluations = 150;
  estimate.feedforward = FeedforwardMode::kJacobian;
  estimate.budget_reduced = true;
  return estimate;
}

TEST(RecogniserMessagesTest, AHeadPoseHoldsTheWholeEstimate) {
  head_pose_t pose = EmptyHeadPose();
  FillHeadPose(AnEstimate(), &pose);
  EXPECT_TRUE(FromMessage(pose).isApprox(*AnEstimate().X_CM, 1e-12));
  EXPECT_NEAR(pose.p_CM_m[2], 1.03, 1e-12);
  EXPECT_NEAR(pose.euler_zyx_CM_rad[0], 4 * M_PI / 180, 1e-12);  // Phi theta psi
  EXPECT_NEAR(pose.euler_zyx_CM_rad[1], -5 * M_PI / 180, 1e-12);
  EXPECT_NEAR(pose.euler_zyx_CM_rad[2], 6 * M_PI / 180, 1e-12);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(pose.covariance[i], 0.5 * i);  // row-major
  EXPECT_EQ(pose.fitness, 1.5);
  EXPECT_EQ(pose.fitness_site, 0.4);
  EXPECT_EQ(pose.fitness_color, 0.8);
  EXPECT_EQ(pose.fitness_feat, 0.3);
  EXPECT_EQ(pose.generations, 3);
  EXPECT_EQ(pose.evaluations, 150);
  EXPECT_TRUE(pose.budget_reduced);
  EXPECT_FALSE(pose.has_world_pose);
}

TEST(RecogniserMessagesTest, StatusAndFeedforwardHaveTheirCodes) {
  Estimate estimate = AnEstimate();
  head_pose_t pose = EmptyHeadPose();
  const std::pair<TrackStatus, int> statuses[] = {
      {TrackStatus::kSearching, head_pose_t::STATUS_SEARCHING},
      {TrackStatus::kTracking, head_pose_t::STATUS_TRACKING},
      {TrackStatus::kLost, head_pose_t::STATUS_LOST}};
  for (const auto& [status, code] : statuses) {
    estimate.status = status;
    FillHeadPose(estimate, &pose);
    EXPECT_EQ(pose.status, code);
  }
  const std::pair<FeedforwardMode, int> modes[] = {
      {FeedforwardMode::kNone, head_pose_t::FEEDFORWARD_NONE},
      {FeedforwardMode::kJacobian, head_pose_t::FEEDFORWARD_JACOBIAN},
      {FeedforwardMode::kExact, head_pose_t::FEEDFORWARD_EXACT}};
  for (const auto& [mode, code] : modes) {
    estimate.feedforward = mode;
    FillHeadPose(estimate, &pose);
    EXPECT_EQ(pose.feedforward, code);
  }
}

TEST(RecogniserMessagesTest, WhatAnEstimateLacksStaysNaN) {
  Estimate estimate = AnEstimate();
  estimate.X_CM.reset();
  estimate.covariance.reset();
  head_pose_t pose = EmptyHeadPose();
  FillHeadPose(estimate, &pose);
  EXPECT_FALSE(HasPose(pose));
  EXPECT_TRUE(std::isnan(pose.covariance[35]));
}

TEST(RecogniserMessagesTest, SourcesHaveTheirCodes) {
  EXPECT_EQ(SourceCode(EgoMotionSource::kNone, false), head_pose_t::SOURCE_NONE);
  EXPECT_EQ(SourceCode(EgoMotionSource::kNone, true), head_pose_t::SOURCE_NONE);
  EXPECT_EQ(SourceCode(EgoMotionSource::kArm, false), head_pose_t::SOURCE_ARM);
  EXPECT_EQ(SourceCode(EgoMotionSource::kArm, true), head_pose_t::SOURCE_MISSING);
  EXPECT_EQ(SourceCode(EgoMotionSource::kCameraPose, false), head_pose_t::SOURCE_CAMERA_POSE);
  EXPECT_EQ(SourceCode(EgoMotionSource::kCameraPose, true), head_pose_t::SOURCE_MISSING);
}

double now_s;

TEST(RecogniserMessagesTest, TimingHasTheStagesInMilliseconds) {
  StageTimer timer(+[] { return now_s; });
  now_s = 0;
  timer.Restart();
  double lasts_s = 0.001;
  for (const Stage stage :
       {Stage::kDecode, Stage::kMap, Stage::kFeedforward, Stage::kGeneration, Stage::kRefinement}) {
    timer.Enter(stage);
    now_s += lasts_s;
    lasts_s *= 2;
  }
  timer.Enter(Stage::kOther);
  recogniser_timing_t timing{};
  FillTiming(timer, &timing);
  EXPECT_NEAR(timing.decode_ms, 1, 1e-9);
  EXPECT_NEAR(timing.map_ms, 2, 1e-9);
  EXPECT_NEAR(timing.feedforward_ms, 4, 1e-9);
  EXPECT_NEAR(timing.generation_ms, 8, 1e-9);
  EXPECT_NEAR(timing.refinement_ms, 16, 1e-9);
  EXPECT_NEAR(timing.total_ms, 31, 1e-9);
}

TEST(RecogniserMessagesTest, APopulationHoldsEachIndividual) {
  ga_population_t message{};
  message.individuals.resize(9);  // of an earlier, larger one
  std::vector<Individual> population(3);
  for (int i = 0; i < 3; ++i) population[i] = {PhiOf(i, 10, 1000, 20 + i, 30, 40), 2.0 - i, true};
  FillPopulation(population, &message);
  ASSERT_EQ(message.num_individuals, 3);
  ASSERT_EQ(message.individuals.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_FLOAT_EQ(message.individuals[i].p_CM_m[k], static_cast<float>(population[i].phi[k]));
      EXPECT_FLOAT_EQ(message.individuals[i].euler_zyx_CM_rad[k],
                      static_cast<float>(population[i].phi[3 + k]));
    }
    EXPECT_FLOAT_EQ(message.individuals[i].fitness, static_cast<float>(2 - i));
  }
}

recogniser_command_t ASpaceCommand() {
  recogniser_command_t command{};
  const double min[] = {-0.1, -0.2, 0.5, -0.3, -0.4, -0.5};
  const double max[] = {0.1, 0.2, 1.5, 0.3, 0.4, 0.5};
  std::copy(min, min + 6, command.search_min);
  std::copy(max, max + 6, command.search_max);
  return command;
}

TEST(RecogniserMessagesTest, ASearchSpaceIsTakenAsItStands) {
  const SearchSpace space = SearchSpaceFromMessage(ASpaceCommand());
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(space.min[i], ASpaceCommand().search_min[i]);
    EXPECT_EQ(space.max[i], ASpaceCommand().search_max[i]);
  }
}

TEST(RecogniserMessagesTest, ASearchSpaceThatIsEmptyHugeNotFiniteOrBehindTheCameraIsRefused) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  const std::pair<const char*, std::function<void(recogniser_command_t*)>> refused[] = {
      {"search_max", [](auto* c) { c->search_max[1] = c->search_min[1]; }},
      {"search_max", [](auto* c) { c->search_max[1] = c->search_min[1] + 0.009; }},
      {"search_max", [](auto* c) { c->search_max[0] = 20; }},
      {"search_max", [&](auto* c) { c->search_max[5] = nan; }},
      {"search_max", [&](auto* c) { c->search_min[0] = nan; }},
      {"search_max", [&](auto* c) { c->search_min[0] = -infinity; }},
      {"search_min", [](auto* c) { c->search_min[2] = 0.29; }},
      {"search_max", [](auto* c) { c->search_max[3] = 1.41; }},
      {"search_max", [](auto* c) { c->search_min[4] = -1.41; }}};
  for (const auto& [field, spoil] : refused) {
    recogniser_command_t command = ASpaceCommand();
    spoil(&command);
    EXPECT_THAT([&] { SearchSpaceFromMessage(command); },
                ::testing::ThrowsMessage<MessageError>(
                    ::testing::AllOf(::testing::HasSubstr(field), ::testing::HasSubstr("must"))));
  }
}

TEST(RecogniserMessagesTest, RigsAreTheSameButForTheirTimes) {
  const RigDescription rig = RigOnArm(UnevenRig());
  EXPECT_TRUE(SameRig(ToMessage(rig, 1), ToMessage(rig, 99)));
  const std::function<void(RigDescription*)> changes[] = {
      [](auto* r) { r->rig.right.fx += 1e-9; }, [](auto* r) { r->rig.left.height += 1; },
      [](auto* r) { r->X_HC.reset(); },         [](auto* r) { r->arm->tip_link = "sledge"; },
      [](auto* r) { r->arm->urdf += " "; },     [](auto* r) { r->arm.reset(); }};
  for (const auto& change : changes) {
    RigDescription other = rig;
    change(&other);
    EXPECT_FALSE(SameRig(ToMessage(rig, 1), ToMessage(other, 1)));
  }
}

}  // namespace
}  // namespace visavis
