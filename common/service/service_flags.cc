#include "common/service/service_flags.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <ostream>

#include "common/bus/lcm_bus.h"
#include "common/service/version.h"

namespace visavis {
namespace {

constexpr std::size_t kMaxPrefixLength =
    31;  // leaves half of a channel's 63 characters to its name

// "" where it is set to nothing or not at all.
std::string FromEnvironment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

// Subscriptions are regular expressions, so nothing else may enter them.
bool IsPrefix(const std::string& text) {
  return text.size() <= kMaxPrefixLength && std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
         });
}

}  // namespace

ServiceFlags ParseServiceFlags(const ServiceTraits& traits, int argc, char* argv[],
                               std::ostream& out, std::ostream& err) {
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
  CLI::Option* prefix = app.add_option("--prefix", flags.prefix,
                                       "goes before every channel, e.g. ROBOT1_ [VISAVIS_PREFIX]");
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
      app.exit(e, out, err);
    } else {
      err << "visavis-" << traits.name << ": " << e.what() << " (--help shows the flags)\n";
    }
    return flags;
  }
  for (std::size_t i = 0; i < traits.aliases.size(); ++i) {
    if (app.count(traits.aliases[i].flag) > 0) {
      flags.overrides.push_back(traits.aliases[i].key + "=" + alias_values[i]);
    }
  }
  if (flags.lcm_url.empty()) flags.lcm_url = FromEnvironment("LCM_DEFAULT_URL");
  if (flags.lcm_url.empty()) flags.lcm_url = kDefaultLcmUrl;
  if (prefix->count() == 0) flags.prefix = FromEnvironment("VISAVIS_PREFIX");
  if (!IsPrefix(flags.prefix)) {
    err << "visavis-" << traits.name << ": "
        << (prefix->count() > 0 ? "--prefix " : "VISAVIS_PREFIX=") << flags.prefix
        << ": must be at most " << kMaxPrefixLength << " characters of A-Z, 0-9 and _\n";
    flags.exit_now = true;
    flags.exit_code = kExitBadUsage;
  }
  return flags;
}

}  // namespace visavis
