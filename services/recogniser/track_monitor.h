#pragma once

#include <optional>

#include "common/config/rule.h"
#include "common/geometry/rigid_transform.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/search_space.h"

namespace visavis {

/// When the published estimator's best individual counts as the head. A fitness alone does not
/// tell: a skin-coloured cupboard reaches a face's F_color, and a head nodding to the end of the
/// search space its F. To be found, a head must show every term of the fitness at once, lie inside
/// the search space and hold still against the camera's own motion for some frames, which a best
/// individual that jumps from one false place to another does not. To be kept, it need only be
/// where the track is by then, on weaker evidence. README.md: why these figures.
struct TrackMonitorConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("min_fitness", &min_fitness, InRange(-1.0, 3.0));
    a->Visit("min_site", &min_site, InRange(-1.0, 1.0));
    a->Visit("min_color", &min_color, InRange(-1.0, 1.0));
    a->Visit("min_feat", &min_feat, InRange(-1.0, 1.0));
    a->Visit("keep_fitness", &keep_fitness, InRange(-1.0, 3.0));
    a->Visit("keep_color", &keep_color, InRange(-1.0, 1.0));
    a->Visit("keep_feat", &keep_feat, InRange(-1.0, 1.0));
    a->Visit("border_share", &border_share, InRange(0.0, 0.4));
    a->Visit("confirm_frames", &confirm_frames, InRange(1, 1000));
    a->Visit("lose_frames", &lose_frames, InRange(1, 1000));
    a->Visit("max_step_mm", &max_step_mm, InRange(1.0, 1000.0, "mm"));
    a->Visit("max_step_deg", &max_step_deg, InRange(0.5, 180.0, "deg"));
  }
  // To be found.
  double min_fitness{0.9};  ///< of F, Eq. 32, normalised
  double min_site{0.0};     ///< of F_site
  double min_color{0.38};   ///< of F_color; not asked on grey images, nor is F
  double min_feat{0.18};    ///< of F_feat
  // To be kept.
  double keep_fitness{0.6};
  double keep_color{0.38};
  double keep_feat{0.1};
  /// Of each parameter's range: a best individual nearer to the search space's border is where the
  /// space ended, not where the head is. 0: not asked.
  double border_share{0.025};
  int confirm_frames{8};  ///< good frames in a row before TRACKING
  /// Bad frames in a row after which a track must be confirmed anew; after fewer it is taken up
  /// where it would be by now. A bad frame itself is LOST.
  int lose_frames{5};
  double max_step_mm{30};  ///< from the last pose and the track, carried by the camera's motion
  double max_step_deg{8};
};

/// SEARCHING, TRACKING, LOST of the published estimator.
class TrackMonitor {
 public:
  explicit TrackMonitor(const TrackMonitorConfig& config) : config_(config) {}

  void Reset() { *this = TrackMonitor(config_); }

  /// After Reset: the head is known to be at @p X_CM in the first frame, so need not be found.
  void Expect(const RigidTransform& X_CM) { track_X_CM_ = X_CM; }

  /// One frame's best pose, its fitness, how the camera moved since the last, and the space that
  /// was searched.
  TrackStatus Update(const RigidTransform& X_CM, const Fitness& fitness, bool has_color,
                     const CameraStep& step, const SearchSpace& space);

  TrackStatus status() const { return status_; }
  int frames_in_status() const { return frames_in_status_; }
  /// Frames in a row, up to the last, whose fitness would not even keep a head.
  int frames_without_head() const { return frames_without_head_; }

 private:
  bool IsFoundBy(const Fitness& fitness, bool has_color) const;
  bool IsKeptBy(const Fitness& fitness, bool has_color) const;
  bool IsNear(const RigidTransform& X_CM, const RigidTransform& expected) const;
  void Enter(TrackStatus status);

  TrackMonitorConfig config_;
  TrackStatus status_{TrackStatus::kSearching};
  std::optional<RigidTransform> last_X_CM_;   // of the last frame, good or bad
  std::optional<RigidTransform> track_X_CM_;  // where the track is by the camera's motion
  int good_in_a_row_{0}, off_track_in_a_row_{0}, frames_in_status_{0};
  int frames_without_head_{0};
};

}  // namespace visavis
