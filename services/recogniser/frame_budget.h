#pragma once

#include <array>
#include <string>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/estimator.h"

namespace visavis {

/// Keeps the time of live frames within a budget: judges from the frames before how many
/// evaluations the next one may run. It knows no clock; its owner tells it durations. Frames with a
/// track and frames that are searched, which take many times as long, are judged apart.
class FrameBudget {
 public:
  /// @p budget_ms of one frame; 0: none, whatever frames take.
  explicit FrameBudget(double budget_ms) : budget_ms_(budget_ms) {}

  bool is_limited() const { return budget_ms_ > 0; }
  /// A frame took @p ms. Over the budget the share falls in proportion, to half at most, as one
  /// frame may have been interrupted; well within it rises slowly.
  void Took(double ms, bool searched);
  /// For the next frame.
  Effort effort() const { return {kinds_[0].share, kinds_[1].share}; }
  /// One generation takes @p ms here, whatever else a frame takes.
  void SetGeneration(double ms) { generation_ms_ = ms; }
  /// Says that the budget is too small for one generation, or which frames are over it time after
  /// time though they run the fewest evaluations; empty: all is well.
  std::string complaint() const;

  static constexpr double kLeastShare = 0.02;

 private:
  struct Kind {
    double share{1};
    int hopeless_in_a_row{0};
    double least_ms{0};  ///< of those
  };
  std::string TooSmall(const std::string& what_takes, double ms) const;

  double budget_ms_, generation_ms_{0};
  std::array<Kind, 2> kinds_;  // with a track, searched
};

/// [ms] that one generation takes at least, with the refinement that goes with it: of a few tries
/// on plain pictures. @p estimator: fresh, starting from a known pose; it is of no use afterwards.
double LeastGenerationMs(const StereoRig& rig, Estimator* estimator, StageTimer* timer);

}  // namespace visavis
