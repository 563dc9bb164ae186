#include "tests/support/private_network.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

namespace visavis {
namespace {

sockaddr Address(const char* text) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  inet_pton(AF_INET, text, &name.sin_addr);
  sockaddr result;
  std::memcpy(&result, &name, sizeof result);
  return result;
}

/// Whether an interface has it: Linux lets anyone bind to any of 127/8.
bool HasAddress(const char* address) {
  in_addr wanted{};
  inet_pton(AF_INET, address, &wanted);
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return false;
  bool has = false;
  for (const ifaddrs* i = interfaces; i; i = i->ifa_next) {
    has = has ||
          (i->ifa_addr && i->ifa_addr->sa_family == AF_INET &&
           reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr.s_addr == wanted.s_addr);
  }
  freeifaddrs(interfaces);
  return has;
}

bool SetUpLoopback() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  ifreq up{};
  std::strcpy(up.ifr_name, "lo");
  up.ifr_flags = IFF_UP | IFF_RUNNING;
  bool done = ioctl(fd, SIOCSIFFLAGS, &up) == 0;
  for (const char* number : {"2", "3"}) {
    ifreq more{};
    std::strcpy(more.ifr_name, (std::string("lo:") + number).c_str());
    more.ifr_addr = Address((std::string("127.0.0.") + number).c_str());
    done = done && ioctl(fd, SIOCSIFADDR, &more) == 0;
  }
  rtentry route{};
  route.rt_dst = Address("224.0.0.0");
  route.rt_genmask = Address("240.0.0.0");
  route.rt_flags = RTF_UP;
  char loopback[] = "lo";
  route.rt_dev = loopback;
  done = done && ioctl(fd, SIOCADDRT, &route) == 0;
  close(fd);
  return done;
}

void Write(const char* file, const std::string& text) { std::ofstream(file) << text; }

}  // namespace

std::string EnterPrivateNetwork() {
  static const std::string reason = []() -> std::string {
    const auto uid = getuid(), gid = getgid();
    if (unshare(CLONE_NEWNET) != 0) {
      if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
        return HasAddress("127.0.0.2")
                   ? ""
                   : "no 127.0.0.2 here: 'sudo ip addr add 127.0.0.2/8 dev lo' makes one";
      }
      Write("/proc/self/setgroups", "deny");
      Write("/proc/self/uid_map", "0 " + std::to_string(uid) + " 1");
      Write("/proc/self/gid_map", "0 " + std::to_string(gid) + " 1");
    }
    return SetUpLoopback() ? "" : "the loopback of a private network cannot be set up here";
  }();
  return reason;
}

}  // namespace visavis
