// Prints a row of the README.s table: two GigE Vision cameras over loopback, captured for a while.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/support/capture_harness.h"
#include "tests/support/private_network.h"

int main(int argc, char* argv[]) {
  if (argc < 3) {
    std::fprintf(stderr, "capture_runs RATE_HZ SECONDS [KEY=VALUE...]\n");
    return 2;
  }
  const std::string reason = visavis::EnterPrivateNetwork();
  if (!reason.empty()) {
    std::printf("skipped: %s\n", reason.c_str());
    return 0;
  }
  const double rate_hz = std::atof(argv[1]), seconds = std::atof(argv[2]);
  visavis::CaptureHarness::Options options;
  options.frame_rate_hz = rate_hz;
  for (int i = 3; i < argc; ++i) options.settings.push_back(argv[i]);
  visavis::CaptureHarness harness(options);
  if (!harness.ReceivePairs(1, 10)) {
    std::fprintf(stderr, "no pair came: %s\n", harness.process().Err().c_str());
    return 1;
  }
  harness.Receive(1);
  const auto before = visavis::UseOf(harness.process().pid());
  const std::size_t first = harness.events().size();
  harness.Receive(seconds);
  const auto after = visavis::UseOf(harness.process().pid());
  harness.Receive(0.5);
  const auto& events = harness.events();
  const std::int64_t from_tick = events[first].right_tick.value_or(0);
  double skew_sum_us = 0, skew_worst_us = 0;
  int pairs = 0;
  for (std::size_t i = first; i < events.size(); ++i) {
    if (!events[i].skew_us) continue;
    const double skew_us = std::abs(static_cast<double>(*events[i].skew_us));
    skew_sum_us += skew_us;
    if (skew_us > skew_worst_us) skew_worst_us = skew_us;
    ++pairs;
  }
  const int exposed = harness.num_exposed(from_tick), missing = harness.NumMissing(from_tick);
  std::printf("| %.0f | %.0f | %d | %d (%.3f %%) | %d | %.2f | %.2f | %.1f | %d |\n", rate_hz,
              seconds, exposed, missing, 100.0 * missing / exposed, harness.num_wrong(),
              1e-3 * skew_sum_us / pairs, 1e-3 * skew_worst_us,
              100 * (after.cpu_s - before.cpu_s) / seconds, harness.NumLostOnBus(from_tick));
  return harness.num_wrong() == 0 ? 0 : 1;
}
