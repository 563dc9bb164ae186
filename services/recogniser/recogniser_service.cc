#include "services/recogniser/recogniser_service.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/bus/channels.h"
#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/rigs/rig_file.h"
#include "services/recogniser/head_file.h"
#include "services/recogniser/recogniser_messages.h"
#include "services/recogniser/refined/distance_ranges.h"
#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr std::int64_t kNewSessionUs = 1'000'000;  // a jump back beyond this starts a new session

}  // namespace

ServiceTraits RecogniserService::Traits() {
  ServiceTraits traits;
  traits.name = "recogniser";
  traits.description = "Finds a head's 6-DoF pose in stereo pairs from a moving robot";
  traits.replays = true;
  return traits;
}

Replay::Filter RecogniserService::ReplayFilter(const RecogniserConfig& config,
                                               const std::string& prefix) {
  Replay::Filter filter;
  const RecogniserChannels channels = config.channels;
  filter.is_own_output = [channels, prefix,
                          status = service_status_t{}](const LogEvent& event) mutable {
    if (event.channel == prefix + kServiceStatusChannel) {
      const int size = static_cast<int>(event.data.size());
      return status.decode(event.data.data(), 0, size) == size && status.service == "recogniser";
    }
    return event.channel == prefix + channels.head_pose ||
           event.channel == prefix + channels.timing ||
           event.channel == prefix + channels.population;
  };
  filter.is_image = [channel = prefix + channels.stereo_images](const LogEvent& event) {
    return event.channel == channel;
  };
  return filter;
}

RecogniserService::RecogniserService(const RecogniserConfig& config, const ServiceContext& context)
    : config_(config),
      context_(context),
      timer_(&MonotonicSeconds),
      background_(!context.live),
      budget_(context.live ? config.refined.budget_ms : 0),
      arm_clock_(config.arm_clock_bound_ms),
      ego_motion_(EgoMotion::ParseChoice(config.ego_motion)),
      feedforward_(ParseFeedforward(config.feedforward)),
      refined_head_(config.RefinedHead()),
      estimator_name_(config.estimator) {
  SelectSimdTarget(config.simd.c_str());
  if (!config.rig_file.empty()) SetRig(LoadRigFile(config.rig_file));
  const RecogniserChannels& channels = config_.channels;
  Bus* bus = context_.bus;
  bus->Subscribe<stereo_rig_t>(channels.stereo_rig, [this](const stereo_rig_t& m) { OnRig(m); });
  // Live, the newest pair counts: a queue of old ones would only add latency.
  bus->Subscribe<images_t>(
      channels.stereo_images, [this](const images_t& m) { OnImages(m); }, 1);
  bus->Subscribe<arm_state_t>(
      channels.arm_state, [this](const arm_state_t& m) { OnArmState(m); }, 200);
  bus->Subscribe<rigid_transform_t>(
      channels.camera_pose, [this](const rigid_transform_t& m) { OnCameraPose(m); }, 200);
  bus->Subscribe<recogniser_command_t>(channels.command,
                                       [this](const recogniser_command_t& m) { OnCommand(m); });
  context_.status->SetCondition("rig", rig_ ? "" : "no " + channels.stereo_rig + " yet");
}

RecogniserService::~RecogniserService() = default;

// All of the new rig or, where any of it throws, nothing.
void RecogniserService::SetRig(const RigDescription& description) {
  auto preparer = std::make_unique<FramePreparer>(description.rig);
  auto estimator = NewEstimator(estimator_name_, description.rig);
  TellIfBudgetIsTooSmall(description.rig);
  ego_motion_.SetRig(description);
  preparer_ = std::move(preparer);
  estimator_ = std::move(estimator);
  rig_ = description.rig;
  swap_probe_ = std::make_unique<SwapProbe>([this] { return AnyFaceEstimator(); });
  BeginTrack();
}

void RecogniserService::TellIfBudgetIsTooSmall(const StereoRig& rig) {
  if (!budget_.is_limited()) return;
  RefinedSettings settings = config_.RefinedSettings();
  settings.start_X_CM = TransformFromPhi(0.5 * (settings.space.min + settings.space.max));
  RefinedEstimator estimator(settings, refined_head_, rig);
  budget_.SetGeneration(LeastGenerationMs(rig, &estimator, &timer_));
  Complain("budget", budget_.complaint());
}

// Finds whoever is there, in one frame.
std::unique_ptr<Estimator> RecogniserService::AnyFaceEstimator() const {
  RefinedSettings settings = config_.RefinedSettings();
  settings.refined.evidence.confirm_frames = 1;
  settings.start_X_CM.reset();
  HeadGeometry head = refined_head_;
  head.face.reset();
  auto estimator = std::make_unique<RefinedEstimator>(settings, head, *rig_);
  if (commanded_space_) estimator->SetSearchSpace(*commanded_space_);
  estimator->SetEffort(budget_.effort());
  return estimator;
}

std::unique_ptr<Estimator> RecogniserService::NewEstimator(const std::string& name,
                                                           const StereoRig& rig) const {
  std::unique_ptr<Estimator> estimator;
  if (name == "refined") {
    estimator = std::make_unique<RefinedEstimator>(config_.RefinedSettings(), refined_head_, rig,
                                                   &background_);
  } else {
    estimator =
        std::make_unique<PublishedEstimator>(config_.PublishedSettings(), config_.head, rig);
  }
  estimator->SetFeedforward(feedforward_);
  if (commanded_space_) estimator->SetSearchSpace(*commanded_space_);
  return estimator;
}

// The head is looked for afresh: no motion leads to the next pair.
void RecogniserService::BeginTrack() {
  picture_watch_.Forget();
  if (swap_probe_) swap_probe_->Forget();
  for (const char* name : {"stale_images", "swapped_eyes"}) Complain(name, "");
  last_utime_us_.reset();
  head_was_tracked_ = false;
}

void RecogniserService::OnRig(const stereo_rig_t& message) {
  if (rig_message_ && SameRig(message, *rig_message_)) return;
  const RigDescription description = FromMessage(message);
  ProcessWaiting();  // a pair that waits was taken by the old rig
  SetRig(description);
  rig_message_ = message;
  context_.status->SetCondition("rig", "");
}

// Ages are judged in message time. Where the pairs jump back by more than a second a new session
// begins, for instance a log that is played again. Each stream is judged by its own times alone: a
// clock that is seconds off must not end the track with each of its messages.
void RecogniserService::BeginSessionIfPairsJumpBack(std::int64_t utime_us) {
  if (utime_us < 0) return;  // no time; refused with its pair
  if (utime_us < newest_pair_us_ - kNewSessionUs) {
    ProcessWaiting();
    ego_motion_.ForgetSamplesAfter(utime_us + kNewSessionUs);
    if (estimator_) estimator_->Reset();
    last_image_seq_.reset();
    pairs_ = 0;
    BeginTrack();
    newest_pair_us_ = utime_us;
  }
}

// Motion of a new session makes a history forget the old one: a pair that waits goes first.
void RecogniserService::ProcessWaitingOfOldSession(std::int64_t motion_utime_us) {
  if (is_waiting_ && motion_utime_us < waiting_.utime - kNewSessionUs) ProcessWaiting();
}

void RecogniserService::OnArmState(const arm_state_t& message) {
  const bool is_timed = arm_clock_.Accepts(message.clock_offset_s);
  Complain("arm_clock", arm_clock_.complaint());
  arm_is_unsynchronised_ = message.clock_state == arm_state_t::CLOCK_UNSYNCHRONISED;
  if (!is_timed) return;
  ProcessWaitingOfOldSession(message.utime);
  const std::string refused = ego_motion_.AddArmState(
      message.utime, message.joint_names, message.joint_position, message.joint_velocity);
  if (!refused.empty())
    context_.status->Rejected("arm_state_t: " + refused, context_.clock->NowUs());
  CheckReady();
}

void RecogniserService::OnCameraPose(const rigid_transform_t& message) {
  const RigidTransform X_WC = FromMessage(message);
  ProcessWaitingOfOldSession(message.utime);
  const std::string refused = ego_motion_.AddCameraPose(message.utime, X_WC);
  if (!refused.empty())
    context_.status->Rejected("rigid_transform_t: " + refused, context_.clock->NowUs());
  CheckReady();
}

void RecogniserService::OnCommand(const recogniser_command_t& message) {
  // All is checked before anything changes: a bad command is refused whole.
  RequireField(message.utime >= 0, "recogniser_command_t.utime", message.utime, "must be >= 0");
  RequireField(message.pause >= recogniser_command_t::SWITCH_KEEP &&
                   message.pause <= recogniser_command_t::SWITCH_OFF,
               "recogniser_command_t.pause", int{message.pause}, "must be 0, 1 or 2");
  RequireField(message.estimator.empty() || message.estimator == "published" ||
                   message.estimator == "refined",
               "recogniser_command_t.estimator", message.estimator,
               "must be empty, published or refined");
  const FeedforwardMode feedforward =
      message.feedforward.empty() ? feedforward_ : ParseFeedforward(message.feedforward);
  std::optional<SearchSpace> space;
  if (message.set_search_space) space = SearchSpaceFromMessage(message);
  const std::optional<SearchSpace>& next_space = space ? space : commanded_space_;
  const std::string& next = message.estimator.empty() ? estimator_name_ : message.estimator;
  if (next == "refined" && next_space && rig_)
    DistanceRanges(*rig_, *next_space);  // throws where the pictures are too small
  if (space) commanded_space_ = space;

  ProcessWaiting();  // a pair that waits came before the command
  feedforward_ = feedforward;
  if (message.pause == recogniser_command_t::SWITCH_ON) paused_ = true;
  if (message.pause == recogniser_command_t::SWITCH_OFF) paused_ = false;
  context_.status->SetCondition("paused", paused_ ? "paused by command" : "");
  const bool is_other = !message.estimator.empty() && message.estimator != estimator_name_;
  if (is_other) estimator_name_ = message.estimator;
  if (!estimator_) return;
  if (is_other) {
    estimator_ = NewEstimator(estimator_name_, *rig_);
    BeginTrack();
  }
  estimator_->SetFeedforward(feedforward_);
  if (space) estimator_->SetSearchSpace(*space);
  if (message.reset) {
    estimator_->Reset();
    BeginTrack();
  }
}

void RecogniserService::OnImages(const images_t& message) {
  BeginSessionIfPairsJumpBack(message.utime);
  ProcessWaiting();  // a pair that still waits goes first, with what is known of its motion
  const std::int64_t now_us = context_.clock->NowUs();
  if (ego_motion_.IsCertainAt(message.utime) || config_.arm_wait_ms == 0) {
    ProcessPair(message, now_us);
    return;
  }
  waiting_ = message;
  is_waiting_ = true;
  waiting_received_us_ = now_us;
  wait_until_us_ = now_us + std::int64_t{1000} * config_.arm_wait_ms;
}

void RecogniserService::CheckReady() {
  if (is_waiting_ && ego_motion_.IsCertainAt(waiting_.utime)) ProcessWaiting();
}

void RecogniserService::ProcessWaiting() {
  if (!is_waiting_) return;
  is_waiting_ = false;
  wait_until_us_ = kNever;
  ProcessPair(waiting_, waiting_received_us_);
}

void RecogniserService::ProcessPair(const images_t& message, std::int64_t received_us) {
  background_.IsFinished();  // a replay's wait is no frame's time
  timer_.Restart();
  timer_.Enter(Stage::kDecode);
  const Estimate* estimate = nullptr;
  std::string refused;
  if (estimator_ && !paused_) {
    try {
      StereoImages images = FromMessage(message, *rig_);
      picture_watch_.TakeOutStale(&images);
      const StereoFrame frame = preparer_->Prepare(images);
      timer_.Enter(Stage::kOther);
      const CameraStep step =
          last_utime_us_ ? ego_motion_.Between(*last_utime_us_, message.utime) : CameraStep{};
      estimator_->SetEffort(budget_.effort());
      estimate = &estimator_->Process(frame, step, &timer_);
    } catch (const std::exception& e) {  // whatever it is, the pair gets its HEAD_POSE
      refused = e.what();
    }
  }
  TellMissing(message);
  timer_.Enter(Stage::kOther);
  if (estimate && estimator_name_ == "refined") KeepBudget(*estimate);
  PublishEstimate(message, estimate, received_us);
  if (estimate) {
    last_utime_us_ = message.utime;
    newest_pair_us_ = std::max(newest_pair_us_, message.utime);  // of pairs that were any good
  }
  if (!refused.empty()) context_.status->Rejected(refused, context_.clock->NowUs());
  if (estimate) SaveLearnedHead();
  if (estimate) LookForSwappedEyes(message, estimate->status == TrackStatus::kTracking);
  Complain("stale_images", picture_watch_.complaint());
}

// After the pair's pose went out, as nothing may delay it.
void RecogniserService::SaveLearnedHead() {
  const std::string& file = config_.refined.head.save;
  const auto [count, head] = estimator_->learned_head();
  if (count == saved_heads_) return;
  saved_heads_ = count;
  if (file.empty() || head == nullptr) return;
  std::string complaint;
  try {
    SaveHeadFile(file, *head);
  } catch (const std::exception& e) {
    complaint = e.what();
  }
  Complain("save_head", complaint);
}

// After the pair's pose went out: this costs as much as a search.
void RecogniserService::LookForSwappedEyes(const images_t& message, bool is_tracking) {
  const bool are_alike =
      rig_->right.width == rig_->left.width && rig_->right.height == rig_->left.height;
  if (swap_probe_->IsDue(is_tracking) && message.images.size() == 2 && are_alike) {
    StereoImages images = FromMessage(message, *rig_);
    std::swap(images.right, images.left);
    swap_probe_->Try(preparer_->Prepare(images), &timer_);
  }
  if (swap_probe_->found()) ++swapped_pairs_;
  Complain("swapped_eyes",
           swap_probe_->found()
               ? "images of left and right camera are swapped: a head is there only "
                 "when they are exchanged; exchange the cameras or image_types"
               : "");
}

// By the clock, and therefore live only.
void RecogniserService::KeepBudget(const Estimate& estimate) {
  if (!budget_.is_limited()) return;
  if (estimate.budget_reduced) ++reduced_pairs_;
  budget_.Took(timer_.TotalMs(), estimate.searched);
  Complain("budget", budget_.complaint());
}

// Tells of a condition as long as it holds; it stays the last error.
void RecogniserService::Complain(const std::string& name, const std::string& complaint) {
  std::string& told = told_[name];
  if (told == complaint) return;
  told = complaint;
  context_.status->SetCondition(name, complaint);
  if (!complaint.empty()) context_.status->Error(complaint, context_.clock->NowUs());
}

// Counts pairs that never reached us, by the pairs' own numbers.
void RecogniserService::TellMissing(const images_t& message) {
  if (message.images.empty()) return;
  auto seq = FindMetadata(message.images[0], "seq");
  if (seq && *seq < 0) seq.reset();  // no number
  if (seq && last_image_seq_ && *seq - *last_image_seq_ > 1) {
    context_.status->Dropped(*seq - *last_image_seq_ - 1);
  }
  last_image_seq_ = seq;
}

void RecogniserService::UpdateStatus() {
  const bool missing = motion_missing_ || ego_motion_.missing();
  context_.status->SetCondition("motion", missing ? "no " + config_.channels.arm_state + " or " +
                                                        config_.channels.camera_pose +
                                                        ": going on without feedforward"
                                                  : "");
  // Of this machine's own clock nobody needs to be told here: it is not another than its cameras'.
  const bool we_are_synchronised =
      context_.live && context_.status->clock_state() == service_status_t::CLOCK_SYNCHRONISED;
  context_.status->SetCondition(
      "arm_unsynchronised", we_are_synchronised && arm_is_unsynchronised_
                                ? config_.channels.arm_state +
                                      " comes from a machine whose clock is not synchronised: " +
                                      "its offset is unknown, see visavis-doctor"
                                : "");
  context_.status->SetCounter("pairs_without_motion", pairs_without_motion_);
  context_.status->SetCounter("pairs_with_extrapolated_motion", extrapolated_);
  context_.status->SetCounter("arm_states_refused_by_clock", arm_clock_.num_refused());
  context_.status->SetCounter("pairs_with_stale_right_image", picture_watch_.num_stale_right());
  context_.status->SetCounter("pairs_with_stale_left_image", picture_watch_.num_stale_left());
  context_.status->SetCounter("pairs_with_swapped_images", swapped_pairs_);
  context_.status->SetCounter("pairs_with_fewer_evaluations", reduced_pairs_);
}

}  // namespace visavis
