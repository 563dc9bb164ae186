#pragma once

#include <unistd.h>

#include <string>

namespace visavis {

/// A URL for this test process alone: stays on the host (ttl=0), and has a port of its own, since
/// two LCM users on one port hear each other. @p port_offset (0 to 3) for several in one process.
inline std::string TestLcmUrl(int port_offset = 0, const std::string& options = "") {
  const int port = 10000 + 4 * (getpid() % 5000) + port_offset;  // below the ephemeral ports
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0" + options;
}

}  // namespace visavis
