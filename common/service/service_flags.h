#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace visavis {

enum ExitCode { kExitOk = 0, kExitRuntimeError = 1, kExitBadUsage = 2 };

/// A flag that is short for --set: {"--seed", "seed", "seed of all that is random"}.
struct FlagAlias {
  std::string flag;
  std::string key;
  std::string help;
};

/// What a service can do beside running live.
struct ServiceTraits {
  std::string name;                ///< executable's name without visavis-
  std::string description;         ///< one line for --help
  bool has_config{true};           ///< offers --config, --set, --check-config, --print-config
  bool replays{false};             ///< offers --replay IN --record OUT
  bool runs_fast{false};           ///< offers --fast --record OUT: no network, as fast as it can
  std::string list_help;           ///< offers --list, which does this; empty: no such flag
  std::vector<FlagAlias> aliases;  ///< further flags
};

struct ServiceFlags {
  std::string config_file;
  std::string lcm_url;  ///< of --lcm-url, else LCM_DEFAULT_URL, else ours
  std::string prefix;   ///< of --prefix, else VISAVIS_PREFIX; at most 31 of A-Z, 0-9 and _
  std::vector<std::string> overrides;  ///< KEY=VALUE each, in the order given
  bool check_config{false};
  bool print_config{false};
  bool list{false};
  bool fast{false};
  bool keep_images{false};
  std::string replay;  ///< log to read; empty: live
  std::string record;  ///< log to write

  bool exit_now{false};  ///< --help, --version or a bad flag: @p exit_code, after writing
  int exit_code{kExitOk};
};

/// Parses the flags of one service; writes help and version to @p out, what is wrong with a flag to
/// @p err.
ServiceFlags ParseServiceFlags(const ServiceTraits& traits, int argc, char* argv[],
                               std::ostream& out, std::ostream& err);

}  // namespace visavis
