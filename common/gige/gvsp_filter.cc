#include "common/gige/gvsp_filter.h"

#include <arpa/inet.h>
#include <dirent.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

namespace visavis {
namespace {

// The kernel's filter sees a datagram from its UDP header on; a load past its end drops it.
constexpr std::uint32_t kUdpHeader = 8;
constexpr std::uint32_t kSourceAddress = static_cast<std::uint32_t>(SKF_NET_OFF) + 12;
constexpr std::uint32_t kTypeByte = kUdpHeader + 4;
constexpr std::uint32_t kTypeBits = 0x8f;  // what it is, and whether its numbers are long ones

/// Kinds of GVSP packets: the bytes that each has at least, a header of 8 (20 with long numbers),
/// then 36 of a leader, 8 of a trailer, 1 of data; and where it says that it is of an image.
struct Kind {
  std::uint32_t type, least_bytes, payload_type_at;
};
constexpr std::uint32_t kNowhere = 0, kImage = 1;
constexpr Kind kKinds[] = {{0x01, 44, 10}, {0x02, 16, 10}, {0x03, 9, kNowhere},
                           {0x81, 56, 22}, {0x82, 28, 22}, {0x83, 21, kNowhere}};

bool Attach(int fd, std::uint32_t address) {
  const sock_filter pass{BPF_RET | BPF_K, 0, 0, 0xffffffff}, drop{BPF_RET | BPF_K, 0, 0, 0};
  // The two numbers of a comparison: instructions to leave out where it holds, and where not.
  std::vector<sock_filter> program{{BPF_LD | BPF_W | BPF_ABS, 0, 0, kSourceAddress},
                                   {BPF_JMP | BPF_JEQ | BPF_K, 1, 0, address},
                                   drop,
                                   {BPF_LD | BPF_B | BPF_ABS, 0, 0, kTypeByte},
                                   {BPF_ALU | BPF_AND | BPF_K, 0, 0, kTypeBits}};
  for (const Kind& kind : kKinds) {
    const bool says = kind.payload_type_at != kNowhere;
    const std::uint32_t at = kUdpHeader + kind.payload_type_at;
    program.insert(program.end(),
                   {{BPF_JMP | BPF_JEQ | BPF_K, 0, 6, kind.type},
                    {BPF_LD | BPF_W | BPF_LEN, 0, 0, 0},
                    {BPF_JMP | BPF_JGE | BPF_K, 0, 3, kUdpHeader + kind.least_bytes},
                    {static_cast<std::uint16_t>(BPF_LD | BPF_H | BPF_ABS), 0, 0, says ? at : 0},
                    {BPF_JMP | BPF_JEQ | BPF_K, 0, static_cast<std::uint8_t>(says ? 1 : 0), kImage},
                    pass,
                    drop});
  }
  program.push_back(drop);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  return setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) == 0;
}

}  // namespace

int FilterStreamSocket(int local_port, const std::string& camera_address) {
  in_addr camera{};
  DIR* directory = opendir("/proc/self/fd");
  if (!directory) return 0;
  int count = 0;
  if (local_port > 0 && inet_pton(AF_INET, camera_address.c_str(), &camera) == 1) {
    while (const dirent* entry = readdir(directory)) {
      const int fd = std::atoi(entry->d_name);
      sockaddr_in own{};
      int type = 0;
      socklen_t size = sizeof own, type_size = sizeof type;
      if (getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0) continue;
      if (own.sin_family != AF_INET || ntohs(own.sin_port) != local_port) continue;
      if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM)
        continue;
      if (Attach(fd, ntohl(camera.s_addr))) ++count;
    }
  }
  closedir(directory);
  return count;
}

}  // namespace visavis
