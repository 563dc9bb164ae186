#pragma once

#include <regex>
#include <string>
#include <unordered_map>

namespace visavis {

/// Which channels a log takes: those whose whole name fits `include` and not `exclude`.
class ChannelFilter {
 public:
  /// Regular expressions (ECMAScript); an empty @p exclude leaves nothing out.
  /// @throws std::regex_error for what is no regular expression.
  ChannelFilter(const std::string& include, const std::string& exclude);

  /// Allocates nothing for a channel that it has seen.
  bool Takes(const std::string& channel);

 private:
  const std::regex include_, exclude_;
  const bool excludes_;
  std::unordered_map<std::string, bool> seen_;
};

}  // namespace visavis
