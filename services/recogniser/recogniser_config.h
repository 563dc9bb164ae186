#pragma once

#include <cstdint>
#include <string>

#include "common/config/rule.h"
#include "services/recogniser/head_model.h"
#include "services/recogniser/published_estimator.h"
#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/refined_config.h"

namespace visavis {

/// Channels' names, without the prefix.
struct RecogniserChannels {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("stereo_images", &stereo_images, ChannelName());
    a->Visit("stereo_rig", &stereo_rig, ChannelName());
    a->Visit("arm_state", &arm_state, ChannelName());
    a->Visit("camera_pose", &camera_pose, ChannelName());
    a->Visit("command", &command, ChannelName());
    a->Visit("head_pose", &head_pose, ChannelName());
    a->Visit("timing", &timing, ChannelName());
    a->Visit("population", &population, ChannelName());
  }
  std::string stereo_images{"STEREO_IMAGES"};
  std::string stereo_rig{"STEREO_RIG"};
  std::string arm_state{"ARM_STATE"};
  std::string camera_pose{"CAMERA_POSE"};
  std::string command{"RECOGNISER_COMMAND"};
  std::string head_pose{"HEAD_POSE"};
  std::string timing{"RECOGNISER_TIMING"};
  std::string population{"GA_POPULATION"};
};

/// Configuration of the recogniser; see recogniser.yaml.
struct RecogniserConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("estimator", &estimator, OneOf({"published", "refined"}));
    a->Visit("feedforward", &feedforward, OneOf({"none", "jacobian", "exact"}));
    a->Visit("ego_motion", &ego_motion, OneOf({"auto", "arm", "camera_pose", "none"}));
    a->Visit("arm_wait_ms", &arm_wait_ms, InRange(0, 1000, "ms"));
    a->Visit("arm_clock_bound_ms", &arm_clock_bound_ms, InRange(0.0, 10000.0, "ms"));
    a->Visit("seed", &seed, InRange<std::int64_t>(0, 1'000'000'000));
    a->Visit("simd", &simd);
    a->VisitFile("rig_file", &rig_file);
    a->Visit("population_every", &population_every, InRange(0, 1000000));
    a->Visit("search", &search);
    a->Visit("start", &start);
    a->Visit("ga", &ga);
    a->Visit("published", &published);
    a->Visit("refined", &refined);
    a->Visit("head", &head);
    a->Visit("channels", &channels);
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  /// What the published estimator takes of all this.
  PublishedEstimator::Settings PublishedSettings() const;
  /// What the refined estimator takes.
  visavis::RefinedSettings RefinedSettings() const;
  /// The head that the refined estimator looks for; reads refined.head.file.
  /// @throws FieldError for a file that is no head.
  HeadGeometry RefinedHead() const;

  /// published: the paper's method. refined: the same idea taken further.
  std::string estimator{"refined"};
  std::string feedforward{"exact"};
  /// Where the camera's motion comes from. auto: the arm where the rig has one and its states come,
  /// else camera poses where they come, else none.
  std::string ego_motion{"auto"};
  int arm_wait_ms{15};  ///< [ms] how long a pair waits for the first motion sample after it
  /// [ms] arm states whose clock says that it is off by more are not used; 0: all are
  double arm_clock_bound_ms{5};
  std::int64_t seed{1};      ///< of all that is random
  std::string simd{"auto"};  ///< auto, or a SIMD target of this machine; the poses are the same
  std::string rig_file;      ///< rig.yaml used until a STEREO_RIG comes; empty: wait for it
  int population_every{10};  ///< [pairs] between two GA_POPULATION; 0: never
  SearchSpaceConfig search;
  StartConfig start;
  GaConfig ga;
  PublishedConfig published;
  RefinedConfig refined;
  HeadModelConfig head;
  RecogniserChannels channels;
};

/// "none", "jacobian" or "exact". @throws std::invalid_argument for another word.
FeedforwardMode ParseFeedforward(const std::string& word);

}  // namespace visavis
