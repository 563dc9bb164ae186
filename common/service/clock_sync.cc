#include "common/service/clock_sync.h"

#include <cmath>

namespace visavis {

ClockSync InterpretClock(int result, const timex& time) {
  ClockSync sync;
  sync.known = result >= 0;
  sync.synchronised = result >= 0 && result != TIME_ERROR && !(time.status & STA_UNSYNC);
  const double unit_s = time.status & STA_NANO ? 1e-9 : 1e-6;
  sync.offset_s = sync.synchronised ? 1e-6 * static_cast<double>(time.esterror) +
                                          unit_s * std::fabs(static_cast<double>(time.offset))
                                    : std::nan("");
  sync.maximum_error_us = result >= 0 ? time.maxerror : 0;
  return sync;
}

ClockSync ReadClockSync() {
  timex time{};
  const int result = adjtimex(&time);
  return InterpretClock(result, time);
}

}  // namespace visavis
