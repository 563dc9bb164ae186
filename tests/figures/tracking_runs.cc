// How often the published method says TRACKING, and how often wrongly: a line a run, for
// scripts/figures tracking. Usage: tracking_runs LOG [SEEDS]
// Prints: START SEED FRAMES TRACKING FALSE LOCK_S. START is truth (one generation a frame) or
// unknown (30). FRAMES counts those without truth too, and TRACKING with nobody there is false.
// LOCK_S: first TRACKING within 15 mm and 5 deg, -1: never.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "common/core/clock.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"

namespace visavis {
namespace {

struct Run {
  const char* start;
  int seed;
  std::unique_ptr<PublishedEstimator> estimator;
  int frames{0}, tracking{0}, false_tracking{0};
  double lock_s{-1};

  void Count(const Estimate& estimate, const std::optional<RigidTransform>& truth, double time_s) {
    ++frames;
    if (estimate.status != TrackStatus::kTracking) return;
    ++tracking;
    if (!truth) {
      ++false_tracking;
      return;
    }
    const auto error = ComputeRecognitionError(*truth, *estimate.X_CM);
    const double mm = 1e3 * error.position.norm(), deg = error.total_angle * 180 / M_PI;
    if (mm > 30 || deg > 10) ++false_tracking;
    if (lock_s < 0 && mm <= 15 && deg <= 5) lock_s = time_s;
  }
};

std::vector<Run> MakeRuns(const StereoRig& rig, const RigidTransform& X_CM_truth, int seeds) {
  const RecogniserConfig config;
  std::vector<Run> runs;
  for (int seed = 1; seed <= seeds; ++seed) {
    auto settings = config.PublishedSettings();
    settings.seed = static_cast<std::uint64_t>(seed);
    settings.published.generations_per_frame = 30;
    runs.push_back(
        {"unknown", seed, std::make_unique<PublishedEstimator>(settings, config.head, rig)});
    settings.published.generations_per_frame = 1;
    const Vector6d phi = PhiFromTransform(X_CM_truth);
    for (int i = 0; i < 6; ++i)
      settings.start.phi_mm_deg.push_back(phi[i] * (i < 3 ? 1e3 : 180 / M_PI));
    runs.push_back(
        {"truth", seed, std::make_unique<PublishedEstimator>(settings, config.head, rig)});
  }
  return runs;
}

void PrintRuns(const char* log, int seeds) {
  LogPlayer player(log);
  std::vector<Run> runs;
  StageTimer timer(&MonotonicSeconds);
  timer.Restart();
  double start_s = 0;
  while (const LogPlayer::Pair* pair = player.Next()) {
    const double time_s = 1e-6 * static_cast<double>(pair->frame.utime_us);
    if (runs.empty()) {
      if (!pair->truth) continue;  // some start there
      runs = MakeRuns(player.rig(), *pair->truth, seeds);
      start_s = time_s;
    }
    for (Run& run : runs) {
      run.Count(run.estimator->Process(pair->frame, pair->step, &timer), pair->truth,
                time_s - start_s);
    }
  }
  if (runs.empty()) throw std::runtime_error(std::string(log) + ": no pair with truth");
  for (const Run& run : runs) {
    std::printf("%s %d %d %d %d %.3f\n", run.start, run.seed, run.frames, run.tracking,
                run.false_tracking, run.lock_s);
  }
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  if (argc < 2) {
    std::fputs("usage: tracking_runs LOG [SEEDS]\n", stderr);
    return 2;
  }
  try {
    visavis::PrintRuns(argv[1], argc > 2 ? std::max(1, std::atoi(argv[2])) : 3);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "tracking_runs: %s\n", e.what());
    return 1;
  }
}
