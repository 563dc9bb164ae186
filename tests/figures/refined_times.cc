// Times of the refined estimator's whole frames on a recorded log: processor time of one thread, so
// that other programs count little. Usage: refined_times tracking|search|start LOG.lcm [SEED]
//
// tracking: the log's pairs one after the other, from an unknown pose; frames that were tracked
// before and after count. search: each pair alone, as the first of a session. start: the estimator
// made anew, five times. Prints: count, median and 99th percentile [us], TRACKING % of the count,
// resident memory of the process [MB] after the first tenth of the log and at its end.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "services/recogniser/background_thread.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

double ProcessorSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double ResidentMb() {
  std::ifstream statm("/proc/self/statm");
  double total = 0, resident = 0;
  statm >> total >> resident;
  return resident * 4096 / 1e6;
}

struct Times {
  std::vector<double> us;
  int tracked{0};
  std::vector<double> resident_mb;
};

Times Start(const StereoRig& rig) {
  Times times;
  for (int i = 0; i < 5; ++i) {
    const double start = ProcessorSeconds();
    const RefinedEstimator estimator(RecogniserConfig{}.RefinedSettings(),
                                     RecogniserConfig{}.RefinedHead(), rig);
    times.us.push_back(1e6 * (ProcessorSeconds() - start));
    times.resident_mb.push_back(ResidentMb());
  }
  return times;
}

Times Play(const std::string& log, bool search, std::uint64_t seed) {
  LogPlayer player(log);
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.seed = seed;
  BackgroundThread background(true);
  RefinedEstimator estimator(settings, RecogniserConfig{}.RefinedHead(), player.rig(), &background);
  StageTimer timer(&ProcessorSeconds);
  Times times;
  bool was_tracking = false;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (search) estimator.Reset();
    background.IsFinished();  // waited for outside of the time
    const double start = ProcessorSeconds();
    timer.Restart();
    const bool tracking =
        estimator.Process(pair->frame, pair->step, &timer).status == TrackStatus::kTracking;
    if (search || (was_tracking && tracking)) {
      times.us.push_back(1e6 * (ProcessorSeconds() - start));
      times.tracked += tracking;
    }
    was_tracking = tracking;
    times.resident_mb.push_back(ResidentMb());
  }
  if (times.us.empty()) throw std::runtime_error(log + ": no frame counts");
  return times;
}

void Print(Times times) {
  std::sort(times.us.begin(), times.us.end());
  const std::size_t n = times.us.size();
  std::printf("%zu %.1f %.1f %.1f %.1f %.1f\n", n, times.us[n / 2], times.us[n * 99 / 100],
              100.0 * times.tracked / static_cast<double>(n),
              times.resident_mb[times.resident_mb.size() / 10], times.resident_mb.back());
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  const std::string what = argc == 3 || argc == 4 ? argv[1] : "";
  if (what != "tracking" && what != "search" && what != "start") {
    std::fputs("usage: refined_times tracking|search|start LOG.lcm [SEED]\n", stderr);
    return 2;
  }
  const auto seed = static_cast<std::uint64_t>(argc == 4 ? std::max(0, std::atoi(argv[3])) : 1);
  try {
    visavis::Print(what == "start" ? visavis::Start(visavis::LogPlayer(argv[2]).rig())
                                   : visavis::Play(argv[2], what == "search", seed));
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "refined_times: %s\n", e.what());
    return 1;
  }
}
