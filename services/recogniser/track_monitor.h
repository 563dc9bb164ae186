#pragma once

#include "common/config/rule.h"
#include "common/geometry/rigid_transform.h"
#include "services/recogniser/estimator.h"

namespace visavis {

/// When the published estimator's best individual counts as the head. A fitness alone does not
/// tell: a skin-coloured cupboard reaches a face's F_color. So every term must be there at once,
/// and the pose must hold still against the camera's own motion for some frames, which a best
/// individual that jumps from one false place to another does not.
struct TrackMonitorConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("min_fitness", &min_fitness, InRange(-1.0, 3.0));
    a->Visit("min_site", &min_site, InRange(-1.0, 1.0));
    a->Visit("min_color", &min_color, InRange(-1.0, 1.0));
    a->Visit("min_feat", &min_feat, InRange(-1.0, 1.0));
    a->Visit("confirm_frames", &confirm_frames, InRange(1, 1000));
    a->Visit("lose_frames", &lose_frames, InRange(1, 1000));
    a->Visit("max_step_mm", &max_step_mm, InRange(1.0, 1000.0, "mm"));
    a->Visit("max_step_deg", &max_step_deg, InRange(0.5, 180.0, "deg"));
  }
  double min_fitness{0.62};  ///< of F, Eq. 32, normalised
  double min_site{0.0};      ///< of F_site
  double min_color{0.38};    ///< of F_color; not asked on grey images
  double min_feat{0.16};     ///< of F_feat
  int confirm_frames{8};     ///< good frames in a row before TRACKING
  int lose_frames{5};        ///< bad frames in a row before LOST
  double max_step_mm{40};  ///< from the last pose, carried by the camera's motion, in a good frame
  double max_step_deg{12};
};

/// SEARCHING, TRACKING, LOST of the published estimator.
class TrackMonitor {
 public:
  explicit TrackMonitor(const TrackMonitorConfig& config) : config_(config) {}

  void Reset() { *this = TrackMonitor(config_); }

  /// One frame's best pose, its fitness, and how the camera moved since the last.
  TrackStatus Update(const RigidTransform& X_CM, const Fitness& fitness, bool has_color,
                     const CameraStep& step);

  TrackStatus status() const { return status_; }
  int frames_in_status() const { return frames_in_status_; }

 private:
  bool IsGood(const RigidTransform& X_CM, const Fitness& fitness, bool has_color,
              const CameraStep& step) const;
  void Enter(TrackStatus status);

  TrackMonitorConfig config_;
  TrackStatus status_{TrackStatus::kSearching};
  std::optional<RigidTransform> last_X_CM_;
  int good_in_a_row_{0}, bad_in_a_row_{0}, frames_in_status_{0};
};

}  // namespace visavis
