#pragma once

#include <sys/timex.h>

#include <cstdint>

namespace visavis {

/// How well the host's clock is synchronised, as the kernel knows it from who disciplines the clock
/// (chrony, systemd-timesyncd, ptp4l with phc2sys).
struct ClockSync {
  bool known{false};  ///< the kernel answered; false: nothing below is known
  bool synchronised{false};
  /// [s] estimated error and what is still being slewed away; NaN: not synchronised, so unknown.
  double offset_s;
  /// [us] the most it may be off, as the discipline's bound; grows while it hears of no server.
  std::int64_t maximum_error_us{0};
};

/// What adjtimex() answered: its result and @p time.
ClockSync InterpretClock(int result, const timex& time);

/// Asks the kernel. Needs no privilege.
ClockSync ReadClockSync();

}  // namespace visavis
