// visavis-watch: one line a second of what the recogniser says, beside the truth where there is
// one.
#include <iostream>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/core/clock.h"
#include "common/service/service_flags.h"
#include "common/service/stop_signal.h"
#include "services/watch/pose_summary.h"

namespace visavis {
namespace {

int Watch(const ServiceFlags& flags, const StopSignal& stop) {
  LcmBus bus(flags.lcm_url, flags.prefix);
  PoseSummary summary;
  bus.Subscribe<head_pose_t>(kHeadPoseChannel, [&](const head_pose_t& m) { summary.AddPose(m); });
  bus.Subscribe<head_pose_t>(kHeadPoseTruthChannel,
                             [&](const head_pose_t& m) { summary.AddTruth(m); });
  bus.Subscribe<recogniser_timing_t>(kRecogniserTimingChannel,
                                     [&](const recogniser_timing_t& m) { summary.AddTiming(m); });
  std::cout << PoseSummary::Header() << std::endl;
  double since_s = MonotonicSeconds();
  while (!stop.pending()) {
    bus.HandleOne(50);
    const double now_s = MonotonicSeconds();
    if (now_s - since_s < 1) continue;
    std::cout << summary.Line(now_s - since_s) << std::endl;
    since_s = now_s;
  }
  return kExitOk;
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  try {
    const visavis::StopSignal stop;
    visavis::ServiceTraits traits;
    traits.name = "watch";
    traits.description =
        "Prints one line a second: pose, error against truth, fitness, rate, latency";
    traits.has_config = false;
    const auto flags = visavis::ParseServiceFlags(traits, argc, argv, std::cout, std::cerr);
    return flags.exit_now ? flags.exit_code : visavis::Watch(flags, stop);
  } catch (const std::exception& e) {
    std::cerr << "visavis-watch: " << e.what() << '\n';
    return visavis::kExitRuntimeError;
  }
}
