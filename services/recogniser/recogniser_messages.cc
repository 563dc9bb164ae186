#include "services/recogniser/recogniser_messages.h"

#include <algorithm>

#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"

namespace visavis {
namespace {

std::int8_t StatusCode(TrackStatus status) {
  switch (status) {
    case TrackStatus::kSearching:
      return head_pose_t::STATUS_SEARCHING;
    case TrackStatus::kTracking:
      return head_pose_t::STATUS_TRACKING;
    case TrackStatus::kLost:
      break;
  }
  return head_pose_t::STATUS_LOST;
}

std::int8_t FeedforwardCode(FeedforwardMode mode) {
  switch (mode) {
    case FeedforwardMode::kJacobian:
      return head_pose_t::FEEDFORWARD_JACOBIAN;
    case FeedforwardMode::kExact:
      return head_pose_t::FEEDFORWARD_EXACT;
    case FeedforwardMode::kNone:
      break;
  }
  return head_pose_t::FEEDFORWARD_NONE;
}

}  // namespace

void FillHeadPose(const Estimate& estimate, head_pose_t* message) {
  message->status = StatusCode(estimate.status);
  if (estimate.X_CM) SetPose(*estimate.X_CM, message);
  if (estimate.covariance) {
    Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message->covariance) =
        *estimate.covariance;
  }
  message->fitness = estimate.fitness.total;
  message->fitness_site = estimate.fitness.site;
  message->fitness_color = estimate.fitness.color;
  message->fitness_feat = estimate.fitness.feat;
  message->generations = estimate.generations;
  message->evaluations = estimate.evaluations;
  message->feedforward = FeedforwardCode(estimate.feedforward);
  message->budget_reduced = estimate.budget_reduced;
}

void FillTiming(const StageTimer& timer, recogniser_timing_t* message) {
  message->decode_ms = timer.Ms(Stage::kDecode);
  message->map_ms = timer.Ms(Stage::kMap);
  message->feedforward_ms = timer.Ms(Stage::kFeedforward);
  message->generation_ms = timer.Ms(Stage::kGeneration);
  message->refinement_ms = timer.Ms(Stage::kRefinement);
  message->total_ms = timer.TotalMs();
}

void FillPopulation(const std::vector<Individual>& population, ga_population_t* message) {
  message->num_individuals = static_cast<std::int32_t>(population.size());
  message->individuals.resize(population.size());
  for (std::size_t i = 0; i < population.size(); ++i) {
    individual_t& out = message->individuals[i];
    for (int k = 0; k < 3; ++k) {
      out.p_CM_m[k] = static_cast<float>(population[i].phi[k]);
      out.euler_zyx_CM_rad[k] = static_cast<float>(population[i].phi[3 + k]);
    }
    out.fitness = static_cast<float>(population[i].fitness);
  }
}

std::int8_t SourceCode(EgoMotionSource source, bool missing) {
  if (source == EgoMotionSource::kNone) return head_pose_t::SOURCE_NONE;
  if (missing) return head_pose_t::SOURCE_MISSING;
  return source == EgoMotionSource::kArm ? head_pose_t::SOURCE_ARM
                                         : head_pose_t::SOURCE_CAMERA_POSE;
}

SearchSpace SearchSpaceFromMessage(const recogniser_command_t& message) {
  SearchSpace space;
  for (int i = 0; i < 6; ++i) {
    space.min[i] = message.search_min[i];
    space.max[i] = message.search_max[i];
    RequireField(space.max[i] - space.min[i] >= 0.01 && space.max[i] - space.min[i] < 10,
                 "recogniser_command_t.search_max", space.max[i],
                 "must exceed search_min by 0.01 to 10");
  }
  RequireField(space.min[2] >= 0.3, "recogniser_command_t.search_min", space.min[2],
               "z must be at least 0.3 m");
  for (int i = 3; i < 6; ++i) {
    RequireField(std::max(-space.min[i], space.max[i]) < 1.4, "recogniser_command_t.search_max",
                 space.max[i], "angles must stay within +-1.4 rad");
  }
  return space;
}

bool SameRig(const stereo_rig_t& a, const stereo_rig_t& b) {
  stereo_rig_t same_time = a;
  same_time.utime = b.utime;
  std::vector<std::uint8_t> bytes_a(static_cast<std::size_t>(same_time.getEncodedSize()));
  std::vector<std::uint8_t> bytes_b(static_cast<std::size_t>(b.getEncodedSize()));
  same_time.encode(bytes_a.data(), 0, static_cast<int>(bytes_a.size()));
  b.encode(bytes_b.data(), 0, static_cast<int>(bytes_b.size()));
  return bytes_a == bytes_b;
}

}  // namespace visavis
