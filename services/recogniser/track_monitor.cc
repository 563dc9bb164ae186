#include "services/recogniser/track_monitor.h"

#include <cmath>

namespace visavis {

bool TrackMonitor::IsFoundBy(const Fitness& fitness, bool has_color) const {
  if (fitness.site < config_.min_site || fitness.feat < config_.min_feat) return false;
  return !has_color || (fitness.color >= config_.min_color && fitness.total >= config_.min_fitness);
}

bool TrackMonitor::IsKeptBy(const Fitness& fitness, bool has_color) const {
  if (fitness.feat < config_.keep_feat) return false;
  return !has_color ||
         (fitness.color >= config_.keep_color && fitness.total >= config_.keep_fitness);
}

bool TrackMonitor::IsNear(const RigidTransform& X_CM, const RigidTransform& expected) const {
  const double moved_mm = 1e3 * (X_CM.translation() - expected.translation()).norm();
  const double turned_deg =
      LogRotation(expected.linear().transpose() * X_CM.linear()).norm() * 180 / M_PI;
  return moved_mm <= config_.max_step_mm && turned_deg <= config_.max_step_deg;
}

void TrackMonitor::Enter(TrackStatus status) {
  frames_in_status_ = status == status_ ? frames_in_status_ + 1 : 0;
  status_ = status;
}

TrackStatus TrackMonitor::Update(const RigidTransform& X_CM, const Fitness& fitness, bool has_color,
                                 const CameraStep& step, const SearchSpace& space) {
  for (auto* expected : {&last_X_CM_, &track_X_CM_}) {
    if (*expected && step.known) **expected = step.X_C2C1 * **expected;
  }
  const bool inside =
      config_.border_share == 0 || !space.AtBorder(PhiFromTransform(X_CM), config_.border_share);
  const bool steady = !last_X_CM_ || IsNear(X_CM, *last_X_CM_);
  const bool good = inside && steady && IsFoundBy(fitness, has_color);
  good_in_a_row_ = good ? good_in_a_row_ + 1 : 0;
  last_X_CM_ = X_CM;
  const bool kept = IsKeptBy(fitness, has_color);
  frames_without_head_ = kept ? 0 : frames_without_head_ + 1;

  const bool on_track = inside && track_X_CM_ && IsNear(X_CM, *track_X_CM_) && kept;
  if (on_track || good_in_a_row_ >= config_.confirm_frames) {
    track_X_CM_ = X_CM;
    off_track_in_a_row_ = 0;
    Enter(TrackStatus::kTracking);
    return status_;
  }
  if (++off_track_in_a_row_ >= config_.lose_frames) track_X_CM_.reset();
  Enter(status_ == TrackStatus::kSearching ? status_ : TrackStatus::kLost);
  return status_;
}

}  // namespace visavis
