#pragma once

#include <cstdint>

namespace visavis {

/// Where a library reads the time from: the host's clock when live, the log's time in a replay.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Microseconds since the Unix epoch.
  virtual std::int64_t NowUs() const = 0;
};

/// CLOCK_REALTIME.
class SystemClock final : public Clock {
 public:
  std::int64_t NowUs() const override;
};

/// A clock that its owner sets: replays, simulators faster than real time, tests.
class ManualClock final : public Clock {
 public:
  std::int64_t NowUs() const override { return now_us_; }
  void Set(std::int64_t now_us) { now_us_ = now_us; }

 private:
  std::int64_t now_us_{0};
};

/// CLOCK_MONOTONIC in seconds, for durations alone.
double MonotonicSeconds();

}  // namespace visavis
