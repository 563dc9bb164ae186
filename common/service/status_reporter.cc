#include "common/service/status_reporter.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace visavis {
namespace {

constexpr std::size_t kMaxLatencies = 4096;

std::string HostName() {
  char name[256] = "unknown";
  gethostname(name, sizeof name - 1);
  return name;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double ResidentMegabytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "re");
  if (!file) return std::nan("");
  long total = 0, resident = 0;
  const bool read = std::fscanf(file, "%ld %ld", &total, &resident) == 2;
  std::fclose(file);
  return read ? static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6
              : std::nan("");
}

}  // namespace

std::int8_t ClockStateOf(const ClockSync& clock) {
  if (!clock.known) return service_status_t::CLOCK_UNKNOWN;
  return clock.synchronised ? service_status_t::CLOCK_SYNCHRONISED
                            : service_status_t::CLOCK_UNSYNCHRONISED;
}

StatusReporter::StatusReporter(const std::string& service, const std::string& version) {
  message_.service = service;
  message_.version = version;
  message_.host = HostName();
  message_.pid = getpid();
  message_.state = service_status_t::STATE_STARTING;
  message_.clock_state = service_status_t::CLOCK_UNKNOWN;
  message_.clock_offset_s = std::nan("");
  latencies_ms_.reserve(kMaxLatencies);
}

void StatusReporter::Processed(double latency_ms) {
  ++message_.processed;
  if (!std::isnan(latency_ms) && latencies_ms_.size() < kMaxLatencies) {
    latencies_ms_.push_back(static_cast<float>(latency_ms));
  }
}

void StatusReporter::Dropped(std::int64_t count) { message_.dropped += count; }

void StatusReporter::Rejected(const std::string& reason, std::int64_t now_us) {
  ++message_.rejected;
  Error(reason, now_us);
}

void StatusReporter::Error(const std::string& what, std::int64_t now_us) {
  message_.last_error = what;
  message_.last_error_utime = now_us;
}

void StatusReporter::SetCondition(const std::string& name, const std::string& text) {
  if (text.empty()) {
    conditions_.erase(name);
  } else {
    conditions_[name] = text;
  }
}

void StatusReporter::SetCounter(const std::string& name, std::int64_t value) {
  counters_[name] = value;
}

const service_status_t& StatusReporter::Make(std::int64_t now_us) {
  ReadProcess(now_us);
  SetLatencies();
  message_.state_text.clear();
  for (const auto& [name, text] : conditions_) {
    message_.state_text += (message_.state_text.empty() ? "" : "; ") + text;
  }
  message_.state =
      conditions_.empty() ? service_status_t::STATE_RUNNING : service_status_t::STATE_DEGRADED;
  message_.num_counters = static_cast<std::int32_t>(counters_.size());
  message_.counter_names.clear();
  message_.counters.clear();
  for (const auto& [name, value] : counters_) {
    message_.counter_names.push_back(name);
    message_.counters.push_back(value);
  }
  return message_;
}

void StatusReporter::ReadProcess(std::int64_t now_us) {
  if (start_us_ < 0 || now_us < start_us_) start_us_ = now_us;  // the clock may be set back
  message_.utime = now_us;
  message_.uptime_s = 1e-6 * static_cast<double>(now_us - start_us_);
  const double cpu_s = CpuSeconds();
  const double elapsed_s = last_us_ < 0 ? 0 : 1e-6 * static_cast<double>(now_us - last_us_);
  if (elapsed_s > 0) {
    message_.cpu_percent = 100 * (cpu_s - last_cpu_s_) / elapsed_s;
    message_.rate_hz = static_cast<double>(message_.processed - last_processed_) / elapsed_s;
  }
  last_us_ = now_us;
  last_cpu_s_ = cpu_s;
  last_processed_ = message_.processed;
  message_.memory_mb = ResidentMegabytes();

  const ClockSync clock = ReadClockSync();
  message_.clock_state = ClockStateOf(clock);
  message_.clock_offset_s = clock.offset_s;
}

void StatusReporter::SetLatencies() {
  const auto quantile = [this](double q) {
    if (latencies_ms_.empty()) return std::nan("");
    const auto at =
        static_cast<std::ptrdiff_t>(q * static_cast<double>(latencies_ms_.size() - 1) + 0.5);
    std::nth_element(latencies_ms_.begin(), latencies_ms_.begin() + at, latencies_ms_.end());
    return static_cast<double>(latencies_ms_[static_cast<std::size_t>(at)]);
  };
  message_.latency_p50_ms = quantile(0.5);
  message_.latency_p99_ms = quantile(0.99);
  message_.latency_max_ms = quantile(1.0);
  latencies_ms_.clear();
}

}  // namespace visavis
