#include "common/service/run_service.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <optional>

#include "common/bus/lcm_bus.h"
#include "common/eventlog/event_log.h"
#include "common/eventlog/event_log_writer.h"
#include "common/service/live_loop.h"
#include "common/service/version.h"

namespace visavis {
namespace {

void TellStatusOfRejects(Bus* bus, StatusReporter* status, const Clock* clock) {
  bus->set_reject_handler([status, clock](const std::string& channel, const std::string& reason) {
    status->Rejected(channel + ": " + reason, clock->NowUs());
  });
}

void RequireAnotherFile(const ServiceFlags& flags) {
  if (flags.record.empty() || flags.replay.empty() || !std::filesystem::exists(flags.record) ||
      !std::filesystem::equivalent(flags.replay, flags.record)) {
    return;
  }
  throw std::invalid_argument("--record " + flags.record + ": must be another file than --replay");
}

// In the status a service is called arm_state where its program is visavis-arm-state.
std::string StatusName(const ServiceTraits& traits) {
  std::string name = traits.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

int RunOffline(const ServiceTraits& traits, const ServiceFlags& flags, const StopSignal& stop,
               const ServiceFactory& make_service, Replay::Filter filter) {
  ManualClock clock;
  StatusReporter status(StatusName(traits), kVersion);
  std::optional<EventLogReader> reader;
  if (!flags.replay.empty()) reader.emplace(flags.replay);
  RequireAnotherFile(flags);
  std::optional<EventLogWriter> writer;
  LogBus bus(flags.prefix, &clock, nullptr);
  TellStatusOfRejects(&bus, &status, &clock);
  const auto service = make_service({&bus, &clock, &status, false});
  // Only now: a configuration that is refused must not cost an earlier log.
  if (!flags.record.empty()) {
    writer.emplace(flags.record, EventLogWriter::Mode::kReplace);
    bus.SetWriter(&*writer);
  }
  if (reader) {
    filter.keep_images = flags.keep_images;
    Replay(service.get(), &bus, &clock, &status, writer ? &*writer : nullptr)
        .Run(&*reader, filter, stop);
    if (reader->num_damaged_bytes() > 0) {
      std::cerr << "visavis-" << traits.name << ": " << flags.replay << ": left out "
                << reader->num_damaged_bytes() << " damaged bytes\n";
    }
  } else {
    RunFast(service.get(), &clock, &status, stop);
  }
  if (writer) writer->Close();
  if (status.rejected() > 0) {
    std::cerr << "visavis-" << traits.name << ": refused " << status.rejected()
              << " messages, the last: " << status.last_error() << '\n';
  }
  return kExitOk;
}

}  // namespace

int RunServiceProcess(const ServiceTraits& traits, const ServiceFlags& flags,
                      const StopSignal& stop, const ServiceFactory& make_service,
                      Replay::Filter filter) {
  if (!flags.replay.empty() || flags.fast) {
    return RunOffline(traits, flags, stop, make_service, std::move(filter));
  }
  const SystemClock clock;
  StatusReporter status(StatusName(traits), kVersion);
  LcmBus bus(flags.lcm_url, flags.prefix);
  TellStatusOfRejects(&bus, &status, &clock);
  const auto service = make_service({&bus, &clock, &status, true});
  std::clog << "visavis-" << traits.name << ": running on " << flags.lcm_url << std::endl;
  RunLive(service.get(), &bus, &status, clock, stop);
  std::clog << "visavis-" << traits.name << ": stopped" << std::endl;
  return kExitOk;
}

ServiceFlags ReadFlags(const ServiceTraits& traits, int argc, char* argv[]) {
  return ParseServiceFlags(traits, argc, argv, std::cout, std::cerr);
}

int ReportFailure(const ServiceTraits& traits, const std::exception& e, int exit_code) {
  std::cerr << "visavis-" << traits.name << ": " << e.what() << '\n';
  return exit_code;
}

void PrintText(const std::string& text) { std::cout << text; }

}  // namespace visavis
