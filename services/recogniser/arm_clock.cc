#include "services/recogniser/arm_clock.h"

#include <cmath>
#include <cstdio>

namespace visavis {

bool ArmClock::Accepts(double offset_s) {
  const double offset_ms = 1e3 * std::fabs(offset_s);
  const bool refused = bound_ms_ > 0 && offset_ms > bound_ms_;  // false for NaN
  if (refused) ++num_refused_;
  if (refused == !complaint_.empty()) return !refused;
  complaint_.clear();
  if (refused) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "arm_state_t.clock_offset_s: %.3g: must be at most %.3g (arm_clock_bound_ms), "
                  "arm states are not used: synchronise the clocks, see visavis-doctor",
                  1e-3 * offset_ms, 1e-3 * bound_ms_);
    complaint_ = text;
  }
  return !refused;
}

}  // namespace visavis
