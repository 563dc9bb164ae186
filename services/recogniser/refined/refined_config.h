#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/refined/pose_refiner.h"
#include "services/recogniser/refined/real_population.h"

namespace visavis {

/// When the refined estimator believes a pose.
struct EvidenceConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("lock_log_odds", &lock_log_odds, InRange(-20.0, 20.0));
    a->Visit("lock_likeness", &lock_likeness, InRange(-1.0, 1.0));
    a->Visit("clear_log_odds", &clear_log_odds, InRange(-20.0, 20.0));
    a->Visit("learned_likeness", &learned_likeness, InRange(-1.0, 1.0));
    a->Visit("enrolled_texture_ncc", &enrolled_texture_ncc, InRange(-1.0, 1.0));
    a->Visit("keep_texture_ncc", &keep_texture_ncc, InRange(-1.0, 1.0));
    a->Visit("keep_ncc", &keep_ncc, InRange(-1.0, 1.0));
    a->Visit("keep_stereo_ncc", &keep_stereo_ncc, InRange(-1.0, 1.0));
    a->Visit("confirm_frames", &confirm_frames, InRange(1, 100));
    a->Visit("strange_frames", &strange_frames, InRange(1, 1000));
    a->Visit("one_eye_frames", &one_eye_frames, InRange(0, 1000000));
  }
  double lock_log_odds{4.5};         ///< of a face whoever it is, before TRACKING
  double lock_likeness{0.2};         ///< of its features to a face's, at least, likewise
  double clear_log_odds{7};          ///< beyond all doubt: no other place is looked at
  double learned_likeness{0.33};     ///< of what was learned to a face, at least, not to forget it
  double enrolled_texture_ncc{0.8};  ///< an enrolled face, to be found
  double keep_texture_ncc{0.6};      ///< learned texture, while TRACKING
  double keep_ncc{0.1};              ///< generic pattern, while TRACKING
  double keep_stereo_ncc{0.5};       ///< agreement of both eyes, while TRACKING
  int confirm_frames{1};             ///< good frames in a row before TRACKING
  int strange_frames{15};            ///< so often a face other than the learned one: learn it anew
  int one_eye_frames{10};            ///< so long one eye keeps a track: its depth drifts
};

/// Which head is looked for.
struct HeadChoice {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("shape", &shape, OneOf({"adult", "ellipsoid", "sphere"}));
    a->VisitFile("file", &file);
    a->Visit("scale", &scale, InRange(1e-9, 1e9));
    a->Visit("y_up", &y_up);
    a->Visit("measured", &measured);
    a->Visit("origin_m", &origin_m);
    a->Visit("save", &save);
  }
  /// adult: the generic one. ellipsoid, sphere: the published estimator's sizes (head.*), coarser.
  std::string shape{"adult"};
  /// In its place: a head.yaml, or a closed mesh labelled by the names of its materials; or empty.
  std::string file;
  double scale{1};  ///< of a mesh: metres per unit of the file
  bool y_up{true};  ///< of a mesh: the file's axes are x right, y up, z to the viewer; false: M's
  /// Of a mesh: it is this very person's; learning keeps its shape and frame. false: about so.
  bool measured{true};
  /// Of a mesh: origin of the frame that poses are reported in, in the scaled file's own axes.
  /// Empty: the generic adult's, from the eyes.
  std::vector<double> origin_m;
  /// Where a head is written as head.yaml whenever it was learned from more views; empty: nowhere.
  std::string save;
};

/// All that the refined estimator can be set to.
struct RefinedConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("budget_ms", &budget_ms, InRange(0.0, 10000.0, "ms"));
    a->Visit("track_evaluations", &track_evaluations, InRange(0, 100000));
    a->Visit("search_shots", &search_shots, InRange(0, 100000));
    a->Visit("search_evaluations", &search_evaluations, InRange(100, 100000));
    a->Visit("search_niches", &search_niches, InRange(1, 20));
    a->Visit("niche_evaluations", &niche_evaluations, InRange(1, 10000));
    a->Visit("iterations", &iterations, InRange(2, 50));
    a->Visit("search_iterations", &search_iterations, InRange(2, 50));
    a->Visit("learned_views", &learned_views, InRange(0, 100));
    a->Visit("population", &population);
    a->Visit("refiner", &refiner);
    a->Visit("evidence", &evidence);
    a->Visit("head", &head);
  }
  /// @throws FieldError, keys under @p prefix, for evaluations too few for one generation.
  void ValidateOrThrow(const std::string& prefix) const;

  /// [ms] Live only: where a frame takes longer, the next ones run fewer evaluations. 0: never.
  double budget_ms{100};
  int track_evaluations{60};    ///< of the fitness, in a frame with a track
  int search_shots{1800};       ///< poses glanced at, in a frame without
  int search_evaluations{100};  ///< of the fitness by the GA after them
  int search_niches{6};         ///< best of distinct places, that are evolved and refined then
  int niche_evaluations{60};    ///< of the fitness in each of them
  int iterations{4};            ///< Gauss-Newton, in a frame with a track
  int search_iterations{8};     ///< Gauss-Newton, of each start
  int learned_views{20};        ///< of a head, that its shape and looks are learned from; 0: never
  RealGaConfig population;
  RefinerConfig refiner;
  EvidenceConfig evidence;
  HeadChoice head;
};

/// What a refined estimator is made with.
struct RefinedSettings {
  RefinedConfig refined;
  SearchSpace space;
  bool recentre{true};
  FeedforwardMode feedforward{FeedforwardMode::kExact};
  std::optional<RigidTransform> start_X_CM;     ///< where the head is, if it is known
  std::optional<Eigen::Vector3d> nearest_to_m;  ///< C: which face to take at the start
  std::uint64_t seed{1};
};

}  // namespace visavis
