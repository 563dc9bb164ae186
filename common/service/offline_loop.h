#pragma once

#include <functional>
#include <string>

#include "common/bus/log_bus.h"
#include "common/core/clock.h"
#include "common/service/service.h"
#include "common/service/stop_signal.h"

namespace visavis {

/// Plays a log to a service lock-step, in log time: each event after the wakes that fall due before
/// it. The service's own output of an earlier run is left out.
class Replay {
 public:
  /// @param is_own_output whether an event is an earlier output of this service
  /// @param is_image whether an event holds images; those are recorded only with @p keep_images
  /// Either may be empty: no event is.
  struct Filter {
    std::function<bool(const LogEvent&)> is_own_output;
    std::function<bool(const LogEvent&)> is_image;
    bool keep_images{false};
  };

  /// @p writer may be null. All pointers are aliased.
  Replay(Service* service, LogBus* bus, ManualClock* clock, StatusReporter* status,
         EventLogWriter* writer);

  /// Runs to the log's end or until a stop signal. An exception of a handler is counted in the
  /// status, as in a live run.
  void Run(EventLogReader* reader, const Filter& filter, const StopSignal& stop);

 private:
  void WakeUntil(std::int64_t log_us);
  void PublishStatusIfDue();

  Service& service_;
  LogBus& bus_;
  ManualClock& clock_;
  StatusReporter& status_;
  EventLogWriter* const writer_;
  std::int64_t next_status_us_{-1};
};

/// Runs a service that needs no input, as fast as it goes: its clock jumps from wake to wake.
/// @throws std::runtime_error for a wake that fails and would be due at the same time again.
void RunFast(Service* service, ManualClock* clock, StatusReporter* status, const StopSignal& stop);

}  // namespace visavis
