// Prints one row of the README's table of the published method: a log of the simulator, many seeds,
// with and without feedforward. Usage: published_table NAME LOG [SEEDS] [--header]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "common/config/config_reader.h"
#include "common/core/clock.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"

namespace visavis {
namespace {

constexpr double kSettleS = 2;
constexpr double kLockedMm = 15, kLockedDeg = 5;

// One estimator on one seed, and what became of it.
struct Run {
  std::unique_ptr<PublishedEstimator> estimator;
  double sum_squared_mm{0};
  int frames{0}, false_tracking{0}, tracking{0};
  bool locked{false};

  double rmse_mm() const { return std::sqrt(sum_squared_mm / std::max(frames, 1)); }
};

std::vector<double> PhiMmDeg(const RigidTransform& X_CM) {
  const Vector6d phi = PhiFromTransform(X_CM);
  std::vector<double> result;
  for (int i = 0; i < 6; ++i) result.push_back(phi[i] * (i < 3 ? 1e3 : 180 / M_PI));
  return result;
}

std::vector<Run> MakeRuns(const RecogniserConfig& config, FeedforwardMode mode,
                          const StereoRig& rig, const std::vector<double>& start, int seeds) {
  std::vector<Run> runs(static_cast<std::size_t>(seeds));
  for (int seed = 1; seed <= seeds; ++seed) {
    auto settings = config.PublishedSettings();
    settings.feedforward = mode;
    settings.start.phi_mm_deg = start;
    settings.seed = static_cast<std::uint64_t>(seed);
    runs[static_cast<std::size_t>(seed - 1)].estimator =
        std::make_unique<PublishedEstimator>(settings, config.head, rig);
  }
  return runs;
}

void Step(const LogPlayer::Pair& pair, double time_s, std::vector<Run>* runs) {
  StageTimer timer(&MonotonicSeconds);
  timer.Restart();
  for (Run& run : *runs) {
    const Estimate& estimate = run.estimator->Process(pair.frame, pair.step, &timer);
    if (!pair.truth) continue;
    const auto error = ComputeRecognitionError(*pair.truth, *estimate.X_CM);
    const double mm = 1e3 * error.position.norm(), deg = error.total_angle * 180 / M_PI;
    if (time_s <= kSettleS && mm <= kLockedMm && deg <= kLockedDeg) run.locked = true;
    if (estimate.status == TrackStatus::kTracking) {
      ++run.tracking;
      if (mm > 30 || deg > 10) ++run.false_tracking;
    }
    if (time_s < kSettleS) continue;
    run.sum_squared_mm += mm * mm;
    ++run.frames;
  }
}

double Quantile(const std::vector<Run>& runs, double q) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(run.rmse_mm());
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

int PrintRow(const char* name, const char* log, int seeds) {
  const RecogniserConfig config;
  LogPlayer player(log);
  std::vector<Run> with, jacobian, without, unknown;
  double start_s = 0;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (with.empty()) {
      if (!pair->truth) continue;  // started at the truth
      const auto start = PhiMmDeg(*pair->truth);
      with = MakeRuns(config, FeedforwardMode::kExact, player.rig(), start, seeds);
      jacobian = MakeRuns(config, FeedforwardMode::kJacobian, player.rig(), start, seeds);
      without = MakeRuns(config, FeedforwardMode::kNone, player.rig(), start, seeds);
      unknown = MakeRuns(config, FeedforwardMode::kExact, player.rig(), {}, seeds);
      start_s = 1e-6 * static_cast<double>(pair->frame.utime_us);
    }
    const double time_s = 1e-6 * static_cast<double>(pair->frame.utime_us) - start_s;
    for (auto* runs : {&with, &jacobian, &without, &unknown}) Step(*pair, time_s, runs);
  }
  if (with.empty()) throw std::runtime_error(std::string(log) + ": no pair with truth");
  const auto locked =
      std::count_if(unknown.begin(), unknown.end(), [](const Run& r) { return r.locked; });
  const double with_mm = Quantile(with, 0.5), without_mm = Quantile(without, 0.5);
  std::printf(
      "| %-18s | %5.1f (%.1f-%.1f) | %5.1f (%.1f-%.1f) | %5.1f (%.1f-%.1f) | %4.1f | %2d of %d |\n",
      name, with_mm, Quantile(with, 0), Quantile(with, 1), Quantile(jacobian, 0.5),
      Quantile(jacobian, 0), Quantile(jacobian, 1), without_mm, Quantile(without, 0),
      Quantile(without, 1), without_mm / with_mm, static_cast<int>(locked), seeds);
  return 0;
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  if (argc == 2 && std::strcmp(argv[1], "--header") == 0) {
    std::puts(
        "| RMSE mm, median (range) of the seeds | exact feedforward | jacobian (Eq. 16) | none | "
        "none/exact "
        "| locked in 2 s from unknown |\n|---|---|---|---|---|---|");
    return 0;
  }
  if (argc < 3) {
    std::fputs("usage: published_table NAME LOG [SEEDS]; or --header\n", stderr);
    return 2;
  }
  try {
    return visavis::PrintRow(argv[1], argv[2], argc > 3 ? std::max(1, std::atoi(argv[3])) : 20);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "published_table: %s\n", e.what());
    return 1;
  }
}
