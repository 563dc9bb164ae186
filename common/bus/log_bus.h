#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/bus.h"
#include "common/core/clock.h"
#include "common/eventlog/event_log.h"
#include "common/eventlog/event_log_writer.h"

namespace visavis {

/// What was published could not be written to the log (a full disk): there is no use in going on.
class RecordError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bus without a network: its owner feeds it the events of a log, and what is published goes to
/// another log, stamped with the clock's time; publishing throws RecordError where that fails.
/// Handlers run inside Dispatch().
class LogBus final : public Bus {
 public:
  /// @p writer may be null: what is published is dropped. Both are aliased.
  LogBus(const std::string& prefix, const Clock* clock, EventLogWriter* writer);

  /// From now on what is published goes there. Aliased.
  void SetWriter(EventLogWriter* writer) { writer_ = writer; }

  void SubscribeAll(BytesHandler handler, int queue_capacity) override;

  /// Hands one event to those who subscribed to its channel. @return whether anyone did.
  bool Dispatch(const LogEvent& event);

 private:
  void PublishBytes(const std::string& channel, const std::uint8_t* data, int size) override;
  void SubscribeBytes(const std::string& channel, BytesHandler handler,
                      int queue_capacity) override;

  const Clock& clock_;
  EventLogWriter* writer_;
  std::map<std::string, std::vector<BytesHandler>> handlers_;
  std::vector<BytesHandler> all_handlers_;
};

}  // namespace visavis
