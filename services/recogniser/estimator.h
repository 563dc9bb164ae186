#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/image/image.h"
#include "common/kinematics/feedforward.h"
#include "services/recogniser/genetic_algorithm.h"
#include "services/recogniser/stage_timer.h"
#include "services/recogniser/stereo_fitness.h"

namespace visavis {

/// A stereo pair ready for matching: kRgb, kBgr or kGray, undistorted. At least one is there.
struct StereoFrame {
  std::int64_t utime_us{0};
  std::optional<ImageView> right, left;
};

struct HeadGeometry;

enum class FeedforwardMode { kNone, kJacobian, kExact };

/// How the camera moved from the last frame (C1) to this one (C2).
struct CameraStep {
  bool known{false};  ///< false: no motion known, nothing below counts
  double dt_s{0};     ///< > 0
  RigidTransform X_C2C1{RigidTransform::Identity()};
  RigidTransform X_WC1{RigidTransform::Identity()};
  CameraTwist twist_1;  ///< of C1, for kJacobian
};

/// Shares of the configured evaluations that a frame with a track, and one in which the head is
/// searched, may run: in (0, 1]. At least one generation runs.
struct Effort {
  double tracking{1}, searching{1};
};

enum class TrackStatus { kSearching, kTracking, kLost };

struct Estimate {
  TrackStatus status{TrackStatus::kSearching};
  std::optional<RigidTransform> X_CM;
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;  ///< [p_CM; rotation vector in C]
  Fitness fitness;                                        ///< of X_CM
  int generations{0}, evaluations{0};                     ///< run on this frame
  FeedforwardMode feedforward{FeedforwardMode::kNone};    ///< what carried the population here
  bool searched{false};        ///< everywhere: many more evaluations than with a track
  bool budget_reduced{false};  ///< fewer evaluations than configured: SetEffort()
};

/// Finds the head, frame after frame. One data flow: frame and camera step in, estimate out.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// @p step leads from the last processed frame to this one. The result is valid until the next
  /// call.
  virtual const Estimate& Process(const StereoFrame& frame, const CameraStep& step,
                                  StageTimer* timer) = 0;

  /// Forgets the head: SEARCHING, a new random population.
  virtual void Reset() = 0;

  virtual void SetFeedforward(FeedforwardMode mode) = 0;
  virtual void SetSearchSpace(const SearchSpace& space) = 0;
  /// Frames after which a head that is not known was looked for everywhere.
  virtual int frames_of_a_search() const { return 1; }
  /// From the next frame on; nothing where the evaluations are fixed.
  virtual void SetEffort(const Effort&) {}

  /// The head as it was last learned from many views, and how many have been so far; null: none is
  /// in use. Valid until the next call.
  virtual std::pair<int, const HeadGeometry*> learned_head() const { return {0, nullptr}; }

  /// The evaluated population, fittest first, and how many generations made it.
  virtual const std::vector<Individual>& population() const = 0;
  virtual std::int64_t total_generations() const = 0;
};

}  // namespace visavis
