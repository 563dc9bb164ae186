// RecogniserService: what it publishes for each pair.
#include "common/convert/pose_message.h"
#include "services/recogniser/recogniser_messages.h"
#include "services/recogniser/recogniser_service.h"

namespace visavis {

void RecogniserService::PublishEstimate(const images_t& message, const Estimate* estimate,
                                        std::int64_t received_us) {
  pose_ = EmptyHeadPose();
  pose_.utime = message.utime;
  pose_.seq = pairs_++;
  // Without an estimate: a head that was tracked is lost; one that never was is still searched for.
  pose_.status =
      paused_ || head_was_tracked_ ? head_pose_t::STATUS_LOST : head_pose_t::STATUS_SEARCHING;
  if (estimate) {
    head_was_tracked_ = estimate->status != TrackStatus::kSearching;
    FillHeadPose(*estimate, &pose_);
    FillMotion(message.utime, *estimate);
  }
  context_.bus->Publish(config_.channels.head_pose, pose_);
  PublishTiming(received_us);
  if (estimate && config_.population_every > 0 && pose_.seq % config_.population_every == 0) {
    PublishPopulation(message.utime);
  }
  context_.status->Processed(timing_.latency_ms);
}

// Where the camera was: the pose in the world, and what the feedforward had to go by.
void RecogniserService::FillMotion(std::int64_t utime_us, const Estimate& estimate) {
  const auto camera = ego_motion_.At(utime_us);
  motion_missing_ = !camera && ego_motion_.source() != EgoMotionSource::kNone;
  pose_.feedforward_source = SourceCode(ego_motion_.source(), motion_missing_);
  if (motion_missing_) ++pairs_without_motion_;
  if (!camera) return;
  pose_.feedforward_extrapolated = camera->extrapolated;
  if (camera->extrapolated) ++extrapolated_;
  if (estimate.X_CM) SetWorldPose(camera->X_WC * *estimate.X_CM, &pose_);
}

void RecogniserService::PublishTiming(std::int64_t received_us) {
  timer_.Enter(Stage::kOther);
  timing_.utime = pose_.utime;
  timing_.seq = pose_.seq;
  timing_.received_utime = received_us;
  timing_.published_utime = context_.clock->NowUs();
  FillTiming(timer_, &timing_);
  timing_.latency_ms = context_.live
                           ? 1e-3 * static_cast<double>(timing_.published_utime - pose_.utime)
                           : timing_.total_ms;
  context_.bus->Publish(config_.channels.timing, timing_);
}

void RecogniserService::PublishPopulation(std::int64_t utime_us) {
  population_.utime = utime_us;
  population_.generation = estimator_->total_generations();
  FillPopulation(estimator_->population(), &population_);
  context_.bus->Publish(config_.channels.population, population_);
}

}  // namespace visavis
