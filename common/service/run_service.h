#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "common/bus/bus.h"
#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "common/service/offline_loop.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "common/service/stop_signal.h"

namespace visavis {

/// Makes the service once its bus is there.
using ServiceFactory = std::function<std::unique_ptr<Service>(const ServiceContext&)>;

/// Runs a service as the flags say (live, replay or fast) and returns the exit code; prints what
/// ended it. @p filter serves a replay.
int RunServiceProcess(const ServiceTraits& traits, const ServiceFlags& flags,
                      const StopSignal& stop, const ServiceFactory& make_service,
                      Replay::Filter filter);

/// ParseServiceFlags() with stdout and stderr.
ServiceFlags ReadFlags(const ServiceTraits& traits, int argc, char* argv[]);

/// Prints one line "visavis-NAME: what" to stderr and returns @p exit_code.
int ReportFailure(const ServiceTraits& traits, const std::exception& e, int exit_code);

/// Prints text to stdout.
void PrintText(const std::string& text);

template <typename XService, typename XConfig, typename = void>
struct HasReplayFilter : std::false_type {};
template <typename XService, typename XConfig>
struct HasReplayFilter<
    XService, XConfig,
    std::void_t<decltype(XService::ReplayFilter(std::declval<const XConfig&>(), ""))>>
    : std::true_type {};

template <typename XService, typename = void>
struct HasList : std::false_type {};
template <typename XService>
struct HasList<XService, std::void_t<decltype(XService::List())>> : std::true_type {};

/// The whole life of a service process: signals, flags, configuration, bus, loop, exit code 0
/// (stopped), 1 (failed while running) or 2 (bad flags or configuration).
///
/// XService is a Service with a constructor (const XConfig&, const ServiceContext&), a
/// `static ServiceTraits Traits()` and, where it replays, `static Replay::Filter ReplayFilter(const
/// XConfig&, const std::string& prefix)` and, where it offers --list, `static std::string List()`.
template <typename XService, typename XConfig>
int RunService(int argc, char* argv[]) {
  const ServiceTraits traits = XService::Traits();
  try {
    const StopSignal stop;
    const ServiceFlags flags = ReadFlags(traits, argc, argv);
    if (flags.exit_now) return flags.exit_code;
    if constexpr (HasList<XService>::value) {
      if (flags.list) return PrintText(XService::List()), kExitOk;
    }
    const auto config = LoadConfig<XConfig>(flags.config_file, flags.overrides);
    if (flags.print_config) PrintText(DumpConfig(config) + "\n");
    if (flags.check_config || flags.print_config) return kExitOk;
    Replay::Filter filter;
    if constexpr (HasReplayFilter<XService, XConfig>::value) {
      filter = XService::ReplayFilter(config, flags.prefix);
    }
    return RunServiceProcess(
        traits, flags, stop,
        [&](const ServiceContext& context) { return std::make_unique<XService>(config, context); },
        filter);
  } catch (const std::invalid_argument& e) {
    return ReportFailure(traits, e, kExitBadUsage);
  } catch (const std::exception& e) {
    return ReportFailure(traits, e, kExitRuntimeError);
  }
}

}  // namespace visavis
