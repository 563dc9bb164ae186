#include "services/recogniser/track_monitor.h"

#include <cmath>

namespace visavis {

bool TrackMonitor::IsGood(const RigidTransform& X_CM, const Fitness& fitness, bool has_color,
                          const CameraStep& step) const {
  if (fitness.site < config_.min_site || fitness.feat < config_.min_feat) return false;
  if (has_color && (fitness.color < config_.min_color || fitness.total < config_.min_fitness))
    return false;
  if (!last_X_CM_) return true;
  const RigidTransform expected = step.known ? step.X_C2C1 * *last_X_CM_ : *last_X_CM_;
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
                                 const CameraStep& step) {
  const bool good = IsGood(X_CM, fitness, has_color, step);
  good_in_a_row_ = good ? good_in_a_row_ + 1 : 0;
  bad_in_a_row_ = good ? 0 : bad_in_a_row_ + 1;
  last_X_CM_ = X_CM;
  TrackStatus next = status_;
  if (status_ == TrackStatus::kTracking) {
    if (bad_in_a_row_ >= config_.lose_frames) next = TrackStatus::kLost;
  } else if (good_in_a_row_ >= config_.confirm_frames) {
    next = TrackStatus::kTracking;
  }
  Enter(next);
  return status_;
}

}  // namespace visavis
