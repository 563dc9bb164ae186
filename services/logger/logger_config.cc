#include "services/logger/logger_config.h"

#include <algorithm>
#include <cctype>

#include "services/logger/channel_filter.h"

namespace visavis {

Rule<std::string> LoggerConfig::FileStem() {
  return {[](const std::string& v) {
            return !v.empty() && v[0] != '.' && v.size() <= 100 &&
                   std::all_of(v.begin(), v.end(), [](unsigned char c) {
                     return std::isalnum(c) != 0 || c == '.' || c == '_' || c == '-';
                   });
          },
          "must be 1 to 100 letters, digits, '_', '-' and '.', not first"};
}

Rule<std::string> LoggerConfig::RegularExpression() {
  return {[](const std::string& v) {
            try {
              ChannelFilter(v, v);
            } catch (const std::regex_error&) {
              return false;
            }
            return true;
          },
          "must be a regular expression"};
}

}  // namespace visavis
