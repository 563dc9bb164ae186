// bus_watch: a line for each message that a fleet's test looks at, when it came [us since the Unix
// epoch], its channel and
//   SERVICE_STATUS  service, host, pid, state, counter late_pairs (0: has none), text
//   HEAD_POSE       status (0 searching, 1 tracking, 2 lost)
//   STEREO_IMAGES   seq, bytes of both pictures
//   ARM_STATE       seq
// until SIGTERM. Takes a service's --lcm-url and --prefix.
#include <iostream>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/convert/image_message.h"
#include "common/core/clock.h"
#include "common/service/service_flags.h"
#include "common/service/stop_signal.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

std::int64_t LatePairs(const service_status_t& m) {
  for (std::size_t i = 0; i < m.counter_names.size(); ++i) {
    if (m.counter_names[i] == "late_pairs") return m.counters[i];
  }
  return 0;
}

int Watch(const ServiceFlags& flags, const StopSignal& stop) {
  LcmBus bus(flags.lcm_url, flags.prefix);
  const SystemClock clock;
  const auto line = [&](const char* channel) -> std::ostream& {
    return std::cout << clock.NowUs() << ' ' << channel << ' ';
  };
  bus.Subscribe<service_status_t>(kServiceStatusChannel, [&](const service_status_t& m) {
    line(kServiceStatusChannel) << m.service << ' ' << m.host << ' ' << m.pid << ' ' << int{m.state}
                                << ' ' << LatePairs(m) << ' ' << m.state_text << '\n';
  });
  bus.Subscribe<head_pose_t>(kHeadPoseChannel, [&](const head_pose_t& m) {
    line(kHeadPoseChannel) << int{m.status} << '\n';
  });
  bus.Subscribe<arm_state_t>(
      kArmStateChannel, [&](const arm_state_t& m) { line(kArmStateChannel) << m.seq << '\n'; },
      200);
  bus.Subscribe<images_t>(
      kStereoImagesChannel,
      [&](const images_t& m) {
        std::int64_t bytes = 0;
        for (const image_t& image : m.images) bytes += image.size;
        const auto seq = m.images.empty() ? std::nullopt : FindMetadata(m.images[0], "seq");
        line(kStereoImagesChannel) << seq.value_or(-1) << ' ' << bytes << '\n';
      },
      100);
  while (!stop.pending()) {
    bus.HandleOne(50);
    std::cout << std::flush;
  }
  return kExitOk;
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  try {
    const visavis::StopSignal stop;
    visavis::ServiceTraits traits;
    traits.name = "bus-watch";
    traits.description = "Prints a line for each message that a fleet's test looks at";
    traits.has_config = false;
    const auto flags = visavis::ParseServiceFlags(traits, argc, argv, std::cout, std::cerr);
    return flags.exit_now ? flags.exit_code : visavis::Watch(flags, stop);
  } catch (const std::exception& e) {
    std::cerr << "bus-watch: " << e.what() << '\n';
    return visavis::kExitRuntimeError;
  }
}
