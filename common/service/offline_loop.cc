#include "common/service/offline_loop.h"

#include <algorithm>
#include <stdexcept>

#include "common/bus/channels.h"
#include "common/service/guard.h"

namespace visavis {
namespace {

constexpr std::int64_t kStatusPeriodUs = 1'000'000;
constexpr std::int64_t kNewSessionUs = 1'000'000;  // a jump back beyond this starts a new session

}  // namespace

Replay::Replay(Service* service, LogBus* bus, ManualClock* clock, StatusReporter* status,
               EventLogWriter* writer)
    : service_(*service), bus_(*bus), clock_(*clock), status_(*status), writer_(writer) {}

void Replay::WakeUntil(std::int64_t log_us) {
  while (service_.next_wake_us() <= log_us) {
    clock_.Set(std::max(clock_.NowUs(), service_.next_wake_us()));
    const std::int64_t before = service_.next_wake_us();
    Guard(&status_, clock_, [&] { service_.Wake(); });
    if (service_.next_wake_us() == before)
      break;  // a wake that moves nothing must not hang a replay
  }
}

void Replay::PublishStatusIfDue() {
  if (next_status_us_ < 0 || clock_.NowUs() < next_status_us_ - 2 * kStatusPeriodUs) {
    next_status_us_ = clock_.NowUs() + kStatusPeriodUs;
  }
  if (clock_.NowUs() < next_status_us_) return;
  next_status_us_ = clock_.NowUs() + kStatusPeriodUs;
  Guard(&status_, clock_, [&] { service_.UpdateStatus(); });
  bus_.Publish(kServiceStatusChannel, status_.Make(clock_.NowUs()));
}

void Replay::Run(EventLogReader* reader, const Filter& filter, const StopSignal& stop) {
  LogEvent event;
  bool first = true;
  while (!stop.pending() && reader->Next(&event)) {
    const bool new_session = first || event.utime < clock_.NowUs() - kNewSessionUs;
    if (new_session && !first) service_.Finish();
    if (new_session) clock_.Set(event.utime);
    first = false;
    WakeUntil(event.utime);
    clock_.Set(std::max(clock_.NowUs(), event.utime));
    PublishStatusIfDue();
    if (filter.is_own_output && filter.is_own_output(event)) continue;
    const bool left_out = !filter.keep_images && filter.is_image && filter.is_image(event);
    if (writer_ && !left_out) {
      writer_->Write(event.utime, event.channel, event.data.data(), event.data.size());
    }
    Guard(&status_, clock_, [&] { bus_.Dispatch(event); });
  }
  service_.Finish();
}

void RunFast(Service* service, ManualClock* clock, StatusReporter* status, const StopSignal& stop) {
  while (!stop.pending() && !service->finished() && service->next_wake_us() != Service::kNever) {
    const std::int64_t due_us = service->next_wake_us();
    const std::int64_t rejected = status->rejected();
    clock->Set(std::max(clock->NowUs(), due_us));
    Guard(status, *clock, [&] { service->Wake(); });
    // What fails and asks for the same time again would fail for ever.
    if (service->next_wake_us() == due_us && status->rejected() > rejected) {
      throw std::runtime_error(status->last_error());
    }
  }
  service->Finish();
}

}  // namespace visavis
