#include "tests/support/echo_service.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <stdexcept>

namespace visavis {
namespace {

int MakeNudges(int count) {
  if (count == 0) return -1;
  return eventfd(static_cast<unsigned>(count), EFD_CLOEXEC | EFD_NONBLOCK | EFD_SEMAPHORE);
}

}  // namespace

EchoService::EchoService(const EchoConfig& config, const ServiceContext& context)
    : config_(config),
      context_(context),
      nudges_fd_(MakeNudges(config.num_nudges)),
      next_wake_us_(config.period_ms > 0 ? 0 : kNever) {
  context_.bus->Subscribe<head_pose_t>(config_.input, [this](const head_pose_t& m) { Handle(m); });
}

EchoService::~EchoService() {
  if (nudges_fd_ >= 0) close(nudges_fd_);
}

ServiceTraits EchoService::Traits() {
  ServiceTraits traits;
  traits.name = "echo";
  traits.description = "Answers each message with another one";
  traits.replays = traits.runs_fast = true;
  traits.aliases = {{"--gain", "gain", "factor of seq"}};
  return traits;
}

Replay::Filter EchoService::ReplayFilter(const EchoConfig& config, const std::string& prefix) {
  Replay::Filter filter;
  filter.is_own_output = [input = prefix + config.input, prefix](const LogEvent& event) {
    return event.channel != input && event.channel.rfind(prefix + "ECHO_", 0) == 0;
  };
  filter.is_image = [prefix](const LogEvent& event) { return event.channel == prefix + "IMAGES"; };
  return filter;
}

void EchoService::Handle(const head_pose_t& message) {
  if (message.seq == config_.fail_on_seq) throw std::runtime_error("seq: must not be the failing");
  context_.status->Processed(1e-3 * static_cast<double>(context_.clock->NowUs() - message.utime));
  Publish(config_.output, message.seq * config_.gain);
}

void EchoService::Wake() {
  if (num_wakes_ == config_.fail_on_seq) throw std::runtime_error("wake: must not be the failing");
  eventfd_t nudge = 0;
  if (nudges_fd_ >= 0) eventfd_read(nudges_fd_, &nudge);
  Publish("ECHO_WAKE", num_wakes_++);
  if (config_.period_ms > 0) next_wake_us_ = context_.clock->NowUs() + 1000 * config_.period_ms;
}

bool EchoService::finished() const {
  return config_.num_wakes > 0 && num_wakes_ >= config_.num_wakes;
}

void EchoService::UpdateStatus() { context_.status->SetCounter("wakes", num_wakes_); }

void EchoService::Finish() { Publish("ECHO_FINISHED", num_finishes_++); }

void EchoService::Publish(const std::string& channel, std::int64_t seq) {
  head_pose_t message{};
  message.utime = context_.clock->NowUs();
  message.seq = seq;
  context_.bus->Publish(channel, message);
}

}  // namespace visavis
