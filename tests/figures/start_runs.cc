// Starts the refined estimator anew whenever the head of a log jumps, and counts how soon it is
// found. Usage: start_runs SEED LOG.lcm ... Prints a line for each log: log; starts; found in the
// first frame; within ten frames; never TRACKING before the next jump; TRACKING first elsewhere
// than where the head is (more than 60 mm or 20 deg off: the head offset, which differs by subject
// and is not known here, is below that); median time of a searching frame [ms].
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "common/core/clock.h"
#include "services/recogniser/background_thread.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"

namespace visavis {
namespace {

constexpr double kJumpM = 0.02, kJumpRad = 0.05;
constexpr double kElsewhereM = 0.06, kElsewhereRad = 0.35;
constexpr int kSoon = 10;

bool IsJump(const RigidTransform& from, const RigidTransform& to) {
  const auto change = ComputeRecognitionError(to, from);
  return change.position.norm() > kJumpM || change.total_angle > kJumpRad;
}

struct Counts {
  int starts{0}, at_once{0}, soon{0}, never{0}, elsewhere{0};
  std::vector<double> search_ms;
};

Counts Run(const std::string& log, std::uint64_t seed) {
  LogPlayer player(log);
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.seed = seed;
  BackgroundThread background(true);
  RefinedEstimator estimator(settings, RecogniserConfig{}.RefinedHead(), player.rig(), &background);
  StageTimer timer(&MonotonicSeconds);
  Counts counts;
  std::optional<RigidTransform> last;
  int frame = 0;
  bool found = true;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (!pair->truth) continue;
    if (!last || IsJump(*last, *pair->truth)) {
      counts.never += !found;
      ++counts.starts;
      estimator.Reset();
      frame = 0;
      found = false;
    }
    last = pair->truth;
    background.IsFinished();  // waited for outside of the time
    timer.Restart();
    const Estimate& estimate = estimator.Process(pair->frame, pair->step, &timer);
    timer.Enter(Stage::kOther);
    if (!found) counts.search_ms.push_back(timer.TotalMs());
    if (!found && estimate.status == TrackStatus::kTracking) {
      found = true;
      const auto error = ComputeRecognitionError(*pair->truth, *estimate.X_CM);
      const bool elsewhere =
          error.position.norm() > kElsewhereM || error.total_angle > kElsewhereRad;
      counts.elsewhere += elsewhere;
      counts.at_once += frame == 0 && !elsewhere;
      counts.soon += frame < kSoon && !elsewhere;
    }
    ++frame;
  }
  counts.never += !found;
  std::sort(counts.search_ms.begin(), counts.search_ms.end());
  return counts;
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  if (argc < 3) {
    std::fputs("usage: start_runs SEED LOG.lcm ...\n", stderr);
    return 2;
  }
  try {
    for (int i = 2; i < argc; ++i) {
      const auto c =
          visavis::Run(argv[i], static_cast<std::uint64_t>(std::max(0, std::atoi(argv[1]))));
      std::printf("%s %d %d %d %d %d %.1f\n", argv[i], c.starts, c.at_once, c.soon, c.never,
                  c.elsewhere, c.search_ms.empty() ? 0 : c.search_ms[c.search_ms.size() / 2]);
    }
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "start_runs: %s\n", e.what());
    return 1;
  }
}
