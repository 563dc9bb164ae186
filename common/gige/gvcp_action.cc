#include "common/gige/gvcp_action.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace visavis {
namespace {

constexpr int kGvcpPort = 3956;
constexpr std::uint8_t kKey = 0x42, kScheduled = 0x80;  // no answer is asked for
constexpr std::uint16_t kActionCommand = 0x0100, kPayloadSize = 20;

}  // namespace

std::array<std::uint8_t, 28> ScheduledAction(const ActionKeys& keys, std::uint64_t camera_time_ns,
                                             std::uint16_t number) {
  std::array<std::uint8_t, 28> packet{};
  std::size_t at = 0;
  const auto append = [&](std::uint64_t value, int bytes) {
    for (int i = bytes; i-- > 0;) packet[at++] = static_cast<std::uint8_t>(value >> (8 * i));
  };
  append(kKey, 1);
  append(kScheduled, 1);
  append(kActionCommand, 2);
  append(kPayloadSize, 2);
  append(number, 2);
  append(keys.device_key, 4);
  append(keys.group_key, 4);
  append(keys.group_mask, 4);
  append(camera_time_ns, 8);
  return packet;
}

bool SendToCamera(const std::array<std::uint8_t, 28>& packet, const std::string& camera_address) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(kGvcpPort);
  if (inet_pton(AF_INET, camera_address.c_str(), &name.sin_addr) != 1) return false;
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  const auto sent = sendto(fd, packet.data(), packet.size(), 0,
                           reinterpret_cast<const sockaddr*>(&name), sizeof name);
  close(fd);
  return sent == static_cast<ssize_t>(packet.size());
}

}  // namespace visavis
