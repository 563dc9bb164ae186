#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/service/clock_sync.h"
#include "visavis/service_status_t.hpp"

namespace visavis {

/// CLOCK_* of service_status_t and arm_state_t.
std::int8_t ClockStateOf(const ClockSync& clock);

/// Collects what a service says of itself and makes the service_status_t of each second.
/// Recording a processed input allocates nothing.
class StatusReporter {
 public:
  StatusReporter(const std::string& service, const std::string& version);

  /// One input was handled; @p latency_ms may be NaN.
  void Processed(double latency_ms);
  void Dropped(std::int64_t count);
  /// One input was refused; @p reason names field, value and rule.
  void Rejected(const std::string& reason, std::int64_t now_us);
  /// Something failed that did not end the service.
  void Error(const std::string& what, std::int64_t now_us);

  /// A condition that holds until it is cleared with an empty text: the state is DEGRADED while any
  /// holds, and the status tells all of them. @p name is only the key.
  void SetCondition(const std::string& name, const std::string& text);
  /// A counter of the service's own.
  void SetCounter(const std::string& name, std::int64_t value);

  std::int64_t processed() const { return message_.processed; }
  std::int64_t rejected() const { return message_.rejected; }
  const std::string& last_error() const { return message_.last_error; }
  /// Of the host's clock at the last Make(), as in service_status_t; before: unknown.
  std::int8_t clock_state() const { return message_.clock_state; }
  double clock_offset_s() const { return message_.clock_offset_s; }

  /// The status of the time since the last call.
  const service_status_t& Make(std::int64_t now_us);

 private:
  void ReadProcess(std::int64_t now_us);
  void SetLatencies();

  service_status_t message_{};
  std::map<std::string, std::string> conditions_;
  std::map<std::string, std::int64_t> counters_;
  std::vector<float> latencies_ms_;  // of this second; bounded
  std::int64_t start_us_{-1}, last_us_{-1}, last_processed_{0};
  double last_cpu_s_{0};
};

}  // namespace visavis
