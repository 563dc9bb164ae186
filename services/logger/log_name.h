#pragma once

#include <cstdint>
#include <string>

namespace visavis {

/// Name of a log that begins at @p utime_us >= 0: "NAME-20241122T170501Z.lcm", or for @p copy > 0
/// "NAME-20241122T170501Z-COPY.lcm". UTC, so that names sort by time everywhere.
std::string LogName(const std::string& name, std::int64_t utime_us, int copy);

}  // namespace visavis
