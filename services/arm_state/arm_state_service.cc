#include "services/arm_state/arm_state_service.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/bus/channels.h"
#include "common/convert/rig_message.h"
#include "common/rigs/rig_file.h"
#include "services/arm_state/sources/source_list.h"
#include "visavis/images_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

constexpr std::int64_t kSilentUs = 500'000;
constexpr std::int64_t kClockOffUs = 1'000'000;

std::string Seconds(std::int64_t us) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", 1e-6 * static_cast<double>(us));
  return text;
}

}  // namespace

ServiceTraits ArmStateService::Traits() {
  ServiceTraits traits;
  traits.name = "arm-state";
  traits.description = "Checks an arm's joint states against its URDF and publishes ARM_STATE";
  traits.replays = true;
  traits.aliases = {{"--source", "source", "iiwa, panda, joint_state, csv or simulator"}};
  return traits;
}

Replay::Filter ArmStateService::ReplayFilter(const ArmStateConfig& config,
                                             const std::string& prefix) {
  Replay::Filter filter;
  filter.is_own_output = [channel = prefix + config.arm_state, prefix,
                          status = service_status_t{}](const LogEvent& event) mutable {
    if (event.channel == prefix + kServiceStatusChannel) {
      const int size = static_cast<int>(event.data.size());
      return status.decode(event.data.data(), 0, size) == size && status.service == "arm_state";
    }
    return event.channel == channel;
  };
  filter.is_image = [channel = prefix + kStereoImagesChannel](const LogEvent& event) {
    return event.channel == channel;
  };
  return filter;
}

ArmStateService::ArmStateService(const ArmStateConfig& config, const ServiceContext& context)
    : config_(config), context_(context) {
  if (config_.rig_file.empty()) {
    context_.bus->Subscribe<stereo_rig_t>(config_.stereo_rig,
                                          [this](const stereo_rig_t& m) { OnRig(m); });
    context_.status->SetCondition("rig", "no " + config_.stereo_rig + " with an arm yet");
  } else {
    const RigDescription rig = LoadRigFile(config_.rig_file);
    if (!rig.arm) throw std::invalid_argument(config_.rig_file + ": arm: missing: must be given");
    SetArm(*rig.arm);
  }
  message_.source = config_.source;
  const SourceContext source{
      context_.bus,     context_.clock,
      context_.live,    config_.SourceChannel(),
      config_.csv_file, [this](const JointReading& reading) { OnReading(reading); }};
  source_ = FindSourceKind(config_.source).make(source);
}

std::string ArmStateService::Place() const {
  return config_.source == "csv" ? config_.csv_file : config_.SourceChannel();
}

// All of the new arm or, where it is none that can be used, nothing.
void ArmStateService::SetArm(const ArmDescription& description) {
  const Arm arm(description.urdf, description.base_link, description.tip_link);
  states_ = std::make_unique<StateBuilder>(arm.joints(), config_.States());
  arm_ = description;
  message_.joint_names.clear();
  for (const ArmJoint& joint : arm.joints()) message_.joint_names.push_back(joint.name);
  message_.num_joints = static_cast<std::int32_t>(message_.joint_names.size());
}

void ArmStateService::OnRig(const stereo_rig_t& message) {
  if (message.arm_urdf.empty()) return;
  if (arm_ && message.arm_urdf == arm_->urdf && message.arm_base_link == arm_->base_link &&
      message.arm_tip_link == arm_->tip_link)
    return;
  const RigDescription rig = FromMessage(message);
  if (!rig.arm) return;
  SetArm(*rig.arm);
  context_.status->SetCondition("rig", "");
}

std::int64_t ArmStateService::next_wake_us() const {
  return states_ ? source_->next_wake_us() : kNever;  // a file waits for its arm
}

void ArmStateService::OnReading(const JointReading& reading) {
  const std::int64_t now_us = context_.clock->NowUs();
  ++readings_;
  last_arrival_us_ = now_us;
  if (!states_) {
    context_.status->Dropped(1);
    return;
  }
  const ArmSample* sample = states_->Add(reading, now_us);
  if (!sample) {
    const std::string& why = states_->refusal();
    if (!why.empty()) context_.status->Rejected(Place() + ": " + why, now_us);
    return;
  }
  newest_utime_us_ = sample->utime_us;
  message_.utime = sample->utime_us;
  message_.joint_position.assign(sample->q.data(), sample->q.data() + sample->q.size());
  message_.joint_velocity.assign(sample->qdot.data(), sample->qdot.data() + sample->qdot.size());
  // In a replay nothing may depend on the host's clock.
  message_.clock_state =
      context_.live ? context_.status->clock_state() : arm_state_t::CLOCK_UNKNOWN;
  message_.clock_offset_s = context_.live ? context_.status->clock_offset_s() : std::nan("");
  context_.bus->Publish(config_.arm_state, message_);
  ++message_.seq;
  context_.status->Processed(1e-3 * static_cast<double>(now_us - sample->utime_us));
}

void ArmStateService::UpdateConditions(std::int64_t now_us) {
  const std::int64_t silent_us = now_us - last_arrival_us_;
  std::string source, rate, clock;
  if (last_arrival_us_ < 0) {
    source = "no " + Place() + " yet";
  } else if (silent_us > kSilentUs) {
    source = "no " + Place() + " for " + Seconds(silent_us);
  } else if (last_status_us_ >= 0 && now_us > last_status_us_) {
    const double rate_hz = 1e6 * static_cast<double>(readings_ - readings_before_) /
                           static_cast<double>(now_us - last_status_us_);
    if (rate_hz < config_.min_rate_hz) {
      rate = Place() + " at " + std::to_string(std::lround(rate_hz)) + " Hz, must be at least " +
             std::to_string(std::lround(config_.min_rate_hz)) + " (min_rate_hz)";
    }
  }
  const std::int64_t off_us = last_arrival_us_ - newest_utime_us_;
  if (source.empty() && newest_utime_us_ >= 0 && std::abs(off_us) > kClockOffUs) {
    clock = Place() + " is stamped " + Seconds(std::abs(off_us)) +
            (off_us > 0 ? " behind" : " ahead of") +
            " this host's clock: synchronise the clocks, or set times to mapped";
  }
  context_.status->SetCondition("source", source);
  context_.status->SetCondition("rate", rate);
  context_.status->SetCondition("clock", clock);
}

void ArmStateService::UpdateStatus() {
  const std::int64_t now_us = context_.clock->NowUs();
  UpdateConditions(now_us);
  readings_before_ = readings_;
  last_status_us_ = now_us;
  if (newest_utime_us_ >= 0) context_.status->SetCounter("age_us", now_us - newest_utime_us_);
  if (!states_) return;
  const ReadingCounts& counts = states_->counts();
  context_.status->SetCounter("gaps", counts.gaps);
  context_.status->SetCounter("largest_gap_us", counts.largest_gap_us);
  context_.status->SetCounter("refused_joints", counts.wrong_joints);
  context_.status->SetCounter("refused_not_finite", counts.not_finite);
  context_.status->SetCounter("refused_time", counts.wrong_time);
  context_.status->SetCounter("refused_impossible", counts.impossible);
  context_.status->SetCounter("jumps_followed", counts.jumps_followed);
  context_.status->SetCounter("sessions", counts.sessions);
  context_.status->SetCounter("differentiated", counts.differentiated);
}

}  // namespace visavis
