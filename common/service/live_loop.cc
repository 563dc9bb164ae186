#include "common/service/live_loop.h"

#include <poll.h>
#include <systemd/sd-daemon.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "common/bus/channels.h"
#include "common/service/clock_sync.h"
#include "common/service/guard.h"

namespace visavis {
namespace {

constexpr std::int64_t kStatusPeriodUs = 1'000'000;
constexpr std::int64_t kRetryUs = 100'000;  // a wake that failed is tried again after this
constexpr int kMaxMessagesAtOnce = 64;      // so that a flood cannot starve timers and stop

std::string DescribeSmallBuffer(const ReceiveBuffer& buffer) {
  if (!buffer.too_small()) return "";
  return "receive buffer of " + std::to_string(buffer.granted_bytes) + " bytes where " +
         std::to_string(buffer.asked_bytes) +
         " were asked, raw images will be lost: 'sudo sysctl -w net.core.rmem_max=" +
         std::to_string(buffer.asked_bytes) + "' and restart";
}

// How far off the host's clock may be at most; where it is not synchronised nobody knows.
void TellClock(StatusReporter* status) {
  const ClockSync sync = ReadClockSync();
  if (sync.synchronised) status->SetCounter("clock_maximum_error_us", sync.maximum_error_us);
}

// Microseconds until the earlier of the two, at least 0.
timespec TimeUntil(std::int64_t now_us, std::int64_t due_us) {
  const std::int64_t wait_us = std::max<std::int64_t>(0, due_us - now_us);
  return {static_cast<time_t>(wait_us / 1'000'000), static_cast<long>(wait_us % 1'000'000 * 1000)};
}

}  // namespace

void RunLive(Service* service, LcmBus* bus, StatusReporter* status, const Clock& clock,
             const StopSignal& stop) {
  std::int64_t next_status_us = clock.NowUs(), retry_us = 0;
  const auto next_wake_us = [&] { return std::max(service->next_wake_us(), retry_us); };
  sd_notify(0, "READY=1");
  pollfd fds[] = {{stop.fd(), POLLIN, 0}, {bus->fd(), POLLIN, 0}, {service->wake_fd(), POLLIN, 0}};
  while (!service->finished()) {
    const std::int64_t now_us = clock.NowUs();
    if (now_us < next_status_us - 2 * kStatusPeriodUs)
      next_status_us = now_us;  // the clock was set back
    if (now_us >= retry_us || now_us < retry_us - kRetryUs) retry_us = 0;
    if (now_us >= next_status_us) {
      status->SetCondition("receive_buffer", DescribeSmallBuffer(bus->GetReceiveBuffer()));
      TellClock(status);
      Guard(status, clock, [&] { service->UpdateStatus(); });
      Guard(status, clock, [&] { bus->Publish(kServiceStatusChannel, status->Make(now_us)); });
      sd_notify(0, "WATCHDOG=1");
      next_status_us = std::max(next_status_us + kStatusPeriodUs, now_us);
    }
    if (next_wake_us() <= now_us || (fds[2].revents & POLLIN)) {
      retry_us = now_us + kRetryUs;
      Guard(status, clock, [&] {
        service->Wake();
        retry_us = 0;
      });
    }

    fds[2].fd = retry_us > 0 ? -1 : service->wake_fd();  // a wake that failed is not tried at once
    fds[2].revents = 0;
    const std::int64_t retry_due_us = retry_us > 0 ? retry_us : Service::kNever;
    const timespec wait =
        TimeUntil(clock.NowUs(), std::min({next_status_us, next_wake_us(), retry_due_us}));
    if (ppoll(fds, 3, &wait, nullptr) < 0) {
      if (errno == EINTR) continue;
      throw std::system_error(errno, std::generic_category(), "poll");
    }
    if (fds[0].revents & POLLIN) break;
    if (fds[1].revents & POLLIN) {
      for (int i = 0; i < kMaxMessagesAtOnce; ++i) {
        bool handled = true;
        Guard(status, clock, [&] { handled = bus->HandleOne(0); });
        if (!handled) break;
        if (next_wake_us() <= clock.NowUs()) break;
      }
    }
  }
  sd_notify(0, "STOPPING=1");
  service->Finish();
}

}  // namespace visavis
