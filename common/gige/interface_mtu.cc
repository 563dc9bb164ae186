#include "common/gige/interface_mtu.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <memory>

namespace visavis {
namespace {

constexpr int kEthernetMtu = 1500;

std::uint32_t AddressOf(const sockaddr* address) {
  return reinterpret_cast<const sockaddr_in*>(address)->sin_addr.s_addr;
}

int MtuOf(const char* interface) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return kEthernetMtu;
  ifreq request{};
  std::strncpy(request.ifr_name, interface, IFNAMSIZ - 1);
  const bool known = ioctl(fd, SIOCGIFMTU, &request) == 0;
  close(fd);
  return known ? request.ifr_mtu : kEthernetMtu;
}

}  // namespace

int InterfaceMtu(const std::string& address) {
  in_addr wanted{};
  ifaddrs* interfaces = nullptr;
  if (inet_pton(AF_INET, address.c_str(), &wanted) != 1 || getifaddrs(&interfaces) != 0)
    return kEthernetMtu;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(interfaces, freeifaddrs);
  for (const ifaddrs* i = interfaces; i; i = i->ifa_next) {
    if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET || !i->ifa_netmask) continue;
    if (((AddressOf(i->ifa_addr) ^ wanted.s_addr) & AddressOf(i->ifa_netmask)) == 0)
      return MtuOf(i->ifa_name);
  }
  return kEthernetMtu;
}

}  // namespace visavis
