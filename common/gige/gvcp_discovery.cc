#include "common/gige/gvcp_discovery.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <set>
#include <system_error>

namespace visavis {
namespace {

constexpr int kGvcpPort = 3956;
// Key, flags (acknowledge, broadcast answers allowed), DISCOVERY_CMD, no payload, number.
constexpr std::array<std::uint8_t, 8> kDiscoveryCommand{0x42, 0x11, 0x00, 0x02, 0, 0, 0xff, 0xfe};
constexpr std::size_t kHeaderSize = 8, kAnswerSize = 0xf8;
constexpr std::uint16_t kDiscoveryAnswer = 0x0003;

struct Socket {
  explicit Socket(int descriptor) : fd(descriptor) {}
  ~Socket() { close(fd); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  const int fd;
};

sockaddr_in Name(std::uint32_t address, int port) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  name.sin_addr.s_addr = address;  // in network order
  return name;
}

std::string ToText(in_addr address) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &address, text, sizeof text);
  return text;
}

/// A socket of the interface with this address; nothing where it went meanwhile.
std::unique_ptr<Socket> Open(std::uint32_t address) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) throw std::system_error(errno, std::generic_category(), "camera discovery: socket");
  auto result = std::make_unique<Socket>(fd);
  const int on = 1;
  setsockopt(fd, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  const sockaddr_in name = Name(address, 0);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0) return nullptr;
  return result;
}

void Ask(const Socket& from, std::uint32_t address) {
  const sockaddr_in name = Name(address, kGvcpPort);
  // A network that cannot be reached has no camera: the result does not matter.
  static_cast<void>(sendto(from.fd, kDiscoveryCommand.data(), kDiscoveryCommand.size(), 0,
                           reinterpret_cast<const sockaddr*>(&name), sizeof name));
}

/// Address of this host from which packets to @p address leave.
std::string RouteTo(in_addr address) {
  const Socket probe(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const sockaddr_in name = Name(address.s_addr, kGvcpPort);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  if (connect(probe.fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
      getsockname(probe.fd, reinterpret_cast<sockaddr*>(&own), &size) != 0)
    return "";
  return ToText(own.sin_addr);
}

std::string TextAt(const std::uint8_t* answer, std::size_t offset, std::size_t size) {
  const auto* begin = reinterpret_cast<const char*>(answer + offset);
  return {begin, strnlen(begin, size)};
}

/// Where the camera says that it is; the answer to a broadcast may come from another address of its
/// host. Nothing for one that calls another host's loopback its own.
std::optional<in_addr> AddressOf(const std::uint8_t* answer, in_addr sender,
                                 const std::set<std::uint32_t>& own) {
  in_addr address{};
  std::memcpy(&address, answer + 0x24, sizeof address);
  if (address.s_addr == 0) return sender;
  const bool is_loopback = (ntohl(address.s_addr) >> 24) == 127;
  if (is_loopback && address.s_addr != sender.s_addr && own.count(sender.s_addr) == 0)
    return std::nullopt;
  return address;
}

/// Takes the answers that wait; what is no whole answer is left out.
void Read(const Socket& from, const std::set<std::uint32_t>& own,
          std::vector<GvcpDevice>* devices) {
  std::array<std::uint8_t, 1024> packet;
  sockaddr_in sender{};
  socklen_t size = sizeof sender;
  for (;;) {
    const auto count = recvfrom(from.fd, packet.data(), packet.size(), 0,
                                reinterpret_cast<sockaddr*>(&sender), &size);
    if (count < 0 && errno == ECONNREFUSED) continue;  // nobody there, says the host
    if (count < 0) return;
    if (static_cast<std::size_t>(count) < kHeaderSize + kAnswerSize) continue;
    if (((packet[2] << 8) | packet[3]) != kDiscoveryAnswer || packet[0] != 0) continue;
    const std::uint8_t* answer = packet.data() + kHeaderSize;
    // Registers 0 to 0xf8 of every GigE Vision camera.
    const auto address = AddressOf(answer, sender.sin_addr, own);
    if (!address) continue;
    GvcpDevice device{TextAt(answer, 0x48, 32), TextAt(answer, 0x68, 32), TextAt(answer, 0xd8, 16),
                      TextAt(answer, 0xe8, 16), ToText(*address),         RouteTo(*address)};
    const bool known = std::any_of(devices->begin(), devices->end(), [&](const GvcpDevice& d) {
      return d.address == device.address;
    });
    if (!known) devices->push_back(std::move(device));
  }
}

}  // namespace

bool IsCalled(const GvcpDevice& device, const std::string& name) {
  return !name.empty() && (name == device.serial || name == device.user_name ||
                           name == device.address || name == device.vendor + "-" + device.serial ||
                           name == device.vendor + "-" + device.model + "-" + device.serial);
}

std::vector<GvcpDevice> DiscoverGvcp(int wait_ms, const std::vector<std::string>& addresses) {
  std::vector<std::unique_ptr<Socket>> sockets;
  std::set<std::uint32_t> own_addresses;
  std::set<std::uint32_t> single;  // asked one by one, through whichever interface
  for (const std::string& text : addresses) {
    in_addr address{};
    if (inet_pton(AF_INET, text.c_str(), &address) == 1) single.insert(address.s_addr);
  }
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0)
    throw std::system_error(errno, std::generic_category(), "camera discovery: getifaddrs");
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(interfaces, freeifaddrs);
  for (const ifaddrs* i = interfaces; i; i = i->ifa_next) {
    if (!i->ifa_addr || i->ifa_addr->sa_family != AF_INET || !(i->ifa_flags & IFF_UP)) continue;
    const auto own = reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr.s_addr;
    own_addresses.insert(own);
    single.insert(own);  // a camera made by a program on this host
    if (!(i->ifa_flags & IFF_BROADCAST)) continue;
    auto socket = Open(own);
    if (!socket) continue;
    Ask(*socket, INADDR_BROADCAST);
    if (i->ifa_broadaddr)
      Ask(*socket, reinterpret_cast<const sockaddr_in*>(i->ifa_broadaddr)->sin_addr.s_addr);
    sockets.push_back(std::move(socket));
  }
  if (auto socket = Open(INADDR_ANY)) {
    for (const std::uint32_t address : single) Ask(*socket, address);
    sockets.push_back(std::move(socket));
  }

  std::vector<pollfd> fds;
  for (const auto& socket : sockets) fds.push_back({socket->fd, POLLIN, 0});
  std::vector<GvcpDevice> devices;
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait_ms);
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return devices;
    if (poll(fds.data(), fds.size(), static_cast<int>(left.count())) <= 0) continue;
    for (const auto& socket : sockets) Read(*socket, own_addresses, &devices);
  }
}

}  // namespace visavis
