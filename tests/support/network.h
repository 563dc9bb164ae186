#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace visavis {

/// A URL for this test process alone: stays on the host (ttl=0), and has a port of its own, since
/// two LCM users on one port hear each other. @p port_offset (0 to 3) for several in one process.
inline std::string TestLcmUrl(int port_offset = 0, const std::string& options = "") {
  const int port = 10000 + 4 * (getpid() % 5000) + port_offset;  // below the ephemeral ports
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0" + options;
}

/// Whether this machine routes multicast, without which no test over the network can run. Use as
/// `if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;`
inline bool HasMulticastRoute() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  address.sin_addr.s_addr = htonl(0xEFFF4C43);  // 239.255.76.67
  const bool routed =
      fd >= 0 && connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (fd >= 0) close(fd);
  return routed;
}

inline constexpr char kNoMulticastRoute[] =
    "no multicast route here: 'sudo ip route add 224.0.0.0/4 dev lo' makes one";

}  // namespace visavis
