#include "services/probe_tool/probe_tool.h"

#include <iomanip>
#include <map>
#include <ostream>
#include <string>
#include <tuple>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/core/clock.h"
#include "common/tool/run_tool.h"
#include "services/probe_tool/exchange.h"

namespace visavis {
namespace {

struct Arguments {
  std::string lcm_url{kDefaultLcmUrl}, prefix, name;
  double seconds{1.2}, rate_hz{20};
};

CLI::App* AddCommand(CLI::App* app, const std::string& name, const std::string& what,
                     Arguments* arguments) {
  CLI::App* command = app->add_subcommand(name, what);
  command->add_option("--lcm-url", arguments->lcm_url, "LCM provider")
      ->envname("LCM_DEFAULT_URL")
      ->capture_default_str();
  command->add_option("--prefix", arguments->prefix, "goes before every channel, e.g. ROBOT1_")
      ->envname("VISAVIS_PREFIX");
  command->add_option("--seconds", arguments->seconds, "how long")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  return command;
}

const char* StateName(int state) {
  switch (state) {
    case service_status_t::STATE_STARTING:
      return "STARTING";
    case service_status_t::STATE_RUNNING:
      return "RUNNING";
    case service_status_t::STATE_DEGRADED:
      return "DEGRADED";
    default:
      return "ERROR";
  }
}

// The newest status of every process that is heard, one a line.
void Listen(const Arguments& arguments, std::ostream& out) {
  LcmBus bus(arguments.lcm_url, arguments.prefix);
  std::map<std::tuple<std::string, std::string, int>, service_status_t> heard;
  bus.Subscribe<service_status_t>(kServiceStatusChannel, [&](const service_status_t& m) {
    heard[{m.service, m.host, m.pid}] = m;
  });
  const double end_s = MonotonicSeconds() + arguments.seconds;
  while (MonotonicSeconds() < end_s) bus.HandleOne(20);
  out << std::fixed << std::setprecision(1);
  for (const auto& [who, m] : heard) {
    out << m.service << ' ' << m.host << ' ' << m.pid << ' ' << m.version << ' '
        << StateName(m.state) << ' ' << m.rate_hz << ' ' << m.latency_p50_ms << ' ' << m.state_text
        << '\n';
  }
}

void RunExchange(const Arguments& arguments, std::ostream& out) {
  LcmBus bus(arguments.lcm_url, arguments.prefix);
  Exchange exchange(&bus, arguments.name);
  const double start_s = MonotonicSeconds(), end_s = start_s + arguments.seconds;
  double next_s = start_s;
  for (double now_s = start_s; now_s < end_s; now_s = MonotonicSeconds()) {
    if (now_s >= next_s) {
      exchange.Send();
      next_s += 1 / arguments.rate_hz;
    }
    bus.HandleOne(5);
  }
  for (const auto& [name, peer] : exchange.peers()) {
    out << name << " small " << peer.small.received << ' ' << peer.small.sent() << " large "
        << peer.large.received << ' ' << peer.large.sent() << '\n';
  }
}

}  // namespace

int RunProbeTool(int argc, const char* const* argv, std::ostream& out, std::ostream& err) {
  CLI::App app{"Listens to the LCM network, and tries it, for visavis-fleet", "visavis-probe"};
  app.require_subcommand(1);
  Arguments to_listen, to_exchange;  // of its own each: CLI11 sets both from the environment
  AddCommand(&app, "listen",
             "the services that are heard, one a line:\n"
             "SERVICE HOST PID VERSION STATE RATE_HZ LATENCY_MS WHAT_IS_WRONG",
             &to_listen)
      ->callback([&] { Listen(to_listen, out); });
  CLI::App* exchange =
      AddCommand(&app, "exchange",
                 "sends and counts what others send; for each other one a line:\n"
                 "NAME small RECEIVED SENT large RECEIVED SENT, large ones of 100 kB",
                 &to_exchange);
  exchange->add_option("NAME", to_exchange.name, "this participant")->required();
  exchange->add_option("--rate", to_exchange.rate_hz, "of each size [Hz]")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  exchange->callback([&] { RunExchange(to_exchange, out); });
  return RunTool(&app, argc, argv, out, err);
}

}  // namespace visavis
