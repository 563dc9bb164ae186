#pragma once

#include <string>

#include "common/bus/lcm_bus.h"
#include "common/service/service.h"
#include "common/service/stop_signal.h"

namespace visavis {

/// Runs a live service until SIGINT, SIGTERM or until it has finished: messages, timed wakes,
/// status once a second, READY and WATCHDOG to systemd. An exception that a handler or wake lets
/// out is counted and told in the status, and the service goes on; a wake that failed is tried
/// again 100 ms later.
void RunLive(Service* service, LcmBus* bus, StatusReporter* status, const Clock& clock,
             const StopSignal& stop);

}  // namespace visavis
