#include "common/service/service_flags.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <iostream>

#include "common/bus/lcm_bus.h"
#include "common/service/version.h"

namespace visavis {

ServiceFlags ParseServiceFlags(const ServiceTraits& traits, int argc, char* argv[]) {
  ServiceFlags flags;
  CLI::App app(traits.description, "visavis-" + traits.name);
  app.set_version_flag("--version", "visavis-" + traits.name + " " + kVersion);
  if (traits.has_config) {
    app.add_option("--config", flags.config_file, "YAML file; defaults where it says nothing");
    app.add_option("--set", flags.overrides, "KEY=VALUE over the configuration, e.g. seed=3")
        ->allow_extra_args(false);
    app.add_flag("--check-config", flags.check_config, "check the configuration and exit");
    app.add_flag("--print-config", flags.print_config, "print the configuration in force and exit");
  }
  app.add_option("--lcm-url", flags.lcm_url,
                 std::string("LCM provider [LCM_DEFAULT_URL, then ") + kDefaultLcmUrl + "]");
  app.add_option("--prefix", flags.prefix, "goes before every channel, e.g. ROBOT1_");
  if (!traits.list_help.empty()) app.add_flag("--list", flags.list, traits.list_help);
  std::vector<std::string> alias_values(traits.aliases.size());
  for (std::size_t i = 0; i < traits.aliases.size(); ++i) {
    const FlagAlias& alias = traits.aliases[i];
    app.add_option(alias.flag, alias_values[i],
                   alias.help + " (short for --set " + alias.key + "=)");
  }
  CLI::Option *record = nullptr, *replay = nullptr;
  if (traits.replays || traits.runs_fast) {
    record = app.add_option("--record", flags.record, "log to write");
  }
  if (traits.replays) {
    replay = app.add_option("--replay", flags.replay,
                            "read a log lock-step, as fast as it goes, without a network");
    app.add_flag("--keep-images", flags.keep_images, "with --record: keep the images too")
        ->needs(record)
        ->needs(replay);
  }
  if (traits.runs_fast) {
    auto* fast =
        app.add_flag("--fast", flags.fast, "as fast as it goes, into --record, without a network");
    fast->needs(record);
    if (replay) fast->excludes(replay);
  }
  try {
    app.parse(argc, argv);
    if (!flags.record.empty() && flags.replay.empty() && !flags.fast) {
      throw CLI::RequiresError("--record", traits.replays ? "--replay" : "--fast");
    }
  } catch (const CLI::ParseError& e) {
    flags.exit_now = true;
    flags.exit_code = e.get_exit_code() == 0 ? kExitOk : kExitBadUsage;
    if (flags.exit_code == kExitOk) {
      app.exit(e, std::cout, std::cerr);
    } else {
      std::cerr << "visavis-" << traits.name << ": " << e.what() << " (--help shows the flags)\n";
    }
    return flags;
  }
  for (std::size_t i = 0; i < traits.aliases.size(); ++i) {
    if (app.count(traits.aliases[i].flag) > 0) {
      flags.overrides.push_back(traits.aliases[i].key + "=" + alias_values[i]);
    }
  }
  if (flags.lcm_url.empty()) {
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    flags.lcm_url = from_environment && *from_environment ? from_environment : kDefaultLcmUrl;
  }
  return flags;
}

}  // namespace visavis
