#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace visavis {

/// What one message of an arm says, before any check.
struct JointReading {
  std::int64_t utime_us{0};        ///< by the clock of whoever measured
  std::vector<std::string> names;  ///< empty: the source tells none
  std::vector<double> position;    ///< [rad or m], one a name
  std::vector<double> velocity;    ///< [rad/s or m/s]; empty, or NaN in it: unknown
};

}  // namespace visavis
