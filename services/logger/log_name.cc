#include "services/logger/log_name.h"

#include <cstdio>
#include <ctime>

namespace visavis {

std::string LogName(const std::string& name, std::int64_t utime_us, int copy) {
  const auto seconds = static_cast<std::time_t>(utime_us / 1'000'000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char time[32];
  std::strftime(time, sizeof time, "%Y%m%dT%H%M%SZ", &utc);
  std::string result = name + "-" + time;
  if (copy > 0) result += "-" + std::to_string(copy);
  return result + ".lcm";
}

}  // namespace visavis
