#pragma once

#include <exception>

#include "common/bus/log_bus.h"
#include "common/core/clock.h"
#include "common/service/status_reporter.h"

namespace visavis {

/// Runs what belongs to a service. An exception it lets out is counted and told in the status, and
/// the run goes on; a RecordError ends the run.
template <typename Action>
void Guard(StatusReporter* status, const Clock& clock, const Action& action) {
  try {
    action();
  } catch (const RecordError&) {
    throw;
  } catch (const std::exception& e) {
    status->Rejected(e.what(), clock.NowUs());
  }
}

}  // namespace visavis
