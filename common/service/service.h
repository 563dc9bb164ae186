#pragma once

#include <cstdint>
#include <limits>

#include "common/bus/bus.h"
#include "common/core/clock.h"
#include "common/service/status_reporter.h"

namespace visavis {

/// What a service is given to live on. All are aliased and outlive it.
struct ServiceContext {
  Bus* bus;
  const Clock* clock;      ///< the host's when live; the log's time in a replay
  StatusReporter* status;  ///< counts and conditions; published once a second for the service
  bool live;               ///< false: replay or --fast, where nothing may depend on real time
};

/// One service: message handlers subscribed in its constructor, and timed wakes. All of it runs in
/// one thread; RunService() (run_service.h) drives it.
class Service {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  virtual ~Service() = default;

  /// When Wake() is due, in the clock's microseconds; kNever: no timer.
  virtual std::int64_t next_wake_us() const { return kNever; }
  virtual void Wake() {}
  /// A file descriptor that asks for Wake() while it is readable; -1: none. Live only.
  virtual int wake_fd() const { return -1; }
  /// True once there is nothing left to do: the process ends with exit code 0.
  virtual bool finished() const { return false; }
  /// Called once a second before the status goes out.
  virtual void UpdateStatus() {}
  /// Called at the end of a live run, of a replay, and of each session of a replay (the log jumps
  /// back by more than 1 s): for what is still waiting.
  virtual void Finish() {}
};

}  // namespace visavis
