#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "common/service/offline_loop.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "services/recogniser/arm_clock.h"
#include "services/recogniser/background_thread.h"
#include "services/recogniser/ego_motion.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/frame_budget.h"
#include "services/recogniser/frame_preparer.h"
#include "services/recogniser/picture_watch.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/swap_probe.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/ga_population_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/recogniser_command_t.hpp"
#include "visavis/recogniser_timing_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// Stereo pairs, rig and camera motion in; exactly one HEAD_POSE per pair out.
class RecogniserService final : public Service {
 public:
  static ServiceTraits Traits();
  /// What a replay leaves out of the new log: our own earlier outputs.
  static Replay::Filter ReplayFilter(const RecogniserConfig& config, const std::string& prefix);

  /// @throws std::invalid_argument for a rig_file that cannot be used.
  RecogniserService(const RecogniserConfig& config, const ServiceContext& context);
  ~RecogniserService() override;

  /// A pair waits for its motion sample until then.
  std::int64_t next_wake_us() const override { return wait_until_us_; }
  void Wake() override { ProcessWaiting(); }
  void UpdateStatus() override;
  void Finish() override { ProcessWaiting(); }

 private:
  void OnRig(const stereo_rig_t& message);
  void OnImages(const images_t& message);
  void OnArmState(const arm_state_t& message);
  void OnCameraPose(const rigid_transform_t& message);
  void OnCommand(const recogniser_command_t& message);

  void SetRig(const RigDescription& rig);
  std::unique_ptr<Estimator> AnyFaceEstimator() const;
  std::unique_ptr<Estimator> NewEstimator(const std::string& name, const StereoRig& rig) const;
  void TellIfBudgetIsTooSmall(const StereoRig& rig);
  void BeginTrack();
  void BeginSessionIfPairsJumpBack(std::int64_t utime_us);
  void ProcessWaitingOfOldSession(std::int64_t motion_utime_us);
  void CheckReady();
  void ProcessWaiting();
  void ProcessPair(const images_t& message, std::int64_t received_us);
  void PublishEstimate(const images_t& message, const Estimate* estimate, std::int64_t received_us);
  void FillMotion(std::int64_t utime_us, const Estimate& estimate);
  void PublishTiming(std::int64_t received_us);
  void PublishPopulation(std::int64_t utime_us);
  void LookForSwappedEyes(const images_t& message, bool is_tracking);
  void SaveLearnedHead();
  void Complain(const std::string& name, const std::string& complaint);
  void KeepBudget(const Estimate& estimate);
  void TellMissing(const images_t& message);

  const RecogniserConfig config_;
  const ServiceContext context_;
  StageTimer timer_;
  mutable BackgroundThread background_;
  FrameBudget budget_;                       // none in a replay: nothing there depends on the clock
  std::optional<stereo_rig_t> rig_message_;  // of the rig in use
  std::optional<StereoRig> rig_;
  ArmClock arm_clock_;
  bool arm_is_unsynchronised_{false};  // by the last arm state's own word
  EgoMotion ego_motion_;
  std::unique_ptr<FramePreparer> preparer_;
  std::unique_ptr<Estimator> estimator_;
  PictureWatch picture_watch_;
  std::unique_ptr<SwapProbe> swap_probe_;
  std::map<std::string, std::string> told_;  // conditions by name
  FeedforwardMode feedforward_;
  const HeadGeometry refined_head_;  // read once: its file may be large
  std::string estimator_name_;       // in use

  images_t waiting_;  // the pair that waits; its memory is reused
  bool is_waiting_{false};
  std::int64_t waiting_received_us_{0};
  std::int64_t wait_until_us_{kNever};

  head_pose_t pose_{};
  recogniser_timing_t timing_{};
  ga_population_t population_{};
  std::int64_t pairs_{0}, newest_pair_us_{0}, pairs_without_motion_{0}, extrapolated_{0};
  std::int64_t swapped_pairs_{0}, reduced_pairs_{0};
  std::optional<std::int64_t> last_utime_us_, last_image_seq_;
  std::optional<SearchSpace> commanded_space_;  // outlives a change of the rig
  bool paused_{false};
  bool head_was_tracked_{false};  // the last estimate was TRACKING or LOST
  int saved_heads_{0};            // of those that the estimator has learned
  bool motion_missing_{false};    // at the last pair
};

}  // namespace visavis
