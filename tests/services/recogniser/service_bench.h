#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/log_bus.h"
#include "common/core/clock.h"
#include "common/eventlog/event_log_writer.h"
#include "common/service/status_reporter.h"
#include "services/recogniser/recogniser_service.h"
#include "tests/services/recogniser/sliding_arm.h"
#include "tests/support/temporary_folder.h"

namespace visavis {

/// Time of the first message, so that times in tests are small numbers.
inline constexpr std::int64_t kBaseUs = 1'000'000'000'000;

/// A rig of 64x48 px, for tests that ask what is published and not how good it is.
StereoRig TinyRig();

/// A recogniser whose every best individual counts as tracked from the first frame on.
RecogniserConfig EasyConfig();

/// A stereo pair of plain grey-blue RGB pictures with a dark spot, @p t_us after kBaseUs.
images_t PairAt(std::int64_t t_us, const StereoRig& rig);

/// The pictures of @p frame as RGB, or as JPEG.
images_t PairOf(const StereoFrame& frame, std::int64_t t_us, bool jpeg = false);

arm_state_t ArmAt(std::int64_t t_us, double slide_m, double turn_rad, double slide_m_s = 0,
                  double turn_rad_s = 0);

/// The status' counter of that name; -1: it has none.
std::int64_t CounterOf(const service_status_t& status, const std::string& name);

/// The recogniser on a LogBus, driven as a replay drives it. Times are us after kBaseUs.
class ServiceBench {
 public:
  explicit ServiceBench(const RecogniserConfig& config, const std::string& prefix = "",
                        std::int64_t clock_offset_us = 0, bool live = false);
  ~ServiceBench();

  /// Delivers a message at @p t_us of the log, after the wakes that fall due before it.
  template <typename Message>
  void Send(const std::string& channel, const Message& message, std::int64_t t_us) {
    LogEvent event;
    event.channel = bus_.prefix() + channel;
    event.data.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    Dispatch(event, t_us);
  }
  void Dispatch(const LogEvent& event, std::int64_t t_us);
  void SendRig(const RigDescription& rig, std::int64_t t_us = 0);
  void SendPair(std::int64_t t_us, const StereoRig& rig) {
    Send("STEREO_IMAGES", PairAt(t_us, rig), t_us);
  }

  /// All that was published so far.
  std::vector<LogEvent> Events();
  template <typename Message>
  std::vector<Message> Read(const std::string& channel) {
    std::vector<Message> messages;
    for (const LogEvent& event : Events()) {
      if (event.channel != channel) continue;
      messages.emplace_back();
      messages.back().decode(event.data.data(), 0, static_cast<int>(event.data.size()));
    }
    return messages;
  }
  std::vector<head_pose_t> Poses() { return Read<head_pose_t>(bus_.prefix() + "HEAD_POSE"); }
  /// The bytes of all HEAD_POSE in a row.
  std::vector<std::uint8_t> PoseBytes();

  /// What the service says of itself.
  service_status_t Status();

  RecogniserService& service() { return *service_; }
  StatusReporter& reporter() { return status_; }
  /// When the service wants to be woken, us after kBaseUs; kNever stays.
  std::int64_t next_wake_us() const;

 private:
  TemporaryFolder folder_;
  std::int64_t offset_us_;
  ManualClock clock_;
  EventLogWriter writer_;
  LogBus bus_;
  StatusReporter status_;
  std::unique_ptr<RecogniserService> service_;
};

}  // namespace visavis
