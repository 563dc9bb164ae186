#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <vector>

namespace visavis {

/// Sends GVSP packets of a test's own making to a client's stream port, as a camera would.
class GvspSender {
 public:
  /// @param address dotted, of the client; @param port of its stream
  GvspSender(const char* address, int port) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    inet_pton(AF_INET, address, &to_.sin_addr);
  }
  ~GvspSender() { close(fd_); }
  GvspSender(const GvspSender&) = delete;
  GvspSender& operator=(const GvspSender&) = delete;

  /// @param time_ns the camera's time stamp, by a clock of ns
  void Leader(int frame, int width, int height, std::uint32_t pixel_format, std::uint64_t time_ns) {
    std::vector<std::uint8_t> payload;
    Append(&payload, 1, 4);  // no flags; an image
    Append(&payload, time_ns, 8);
    Append(&payload, pixel_format, 4);
    Append(&payload, static_cast<std::uint64_t>(width), 4);
    Append(&payload, static_cast<std::uint64_t>(height), 4);
    Append(&payload, 0, 4);  // offsets and paddings
    Append(&payload, 0, 4);
    Append(&payload, 0, 4);
    Send(frame, 1, 0, payload);
  }
  void Data(int frame, int packet, std::size_t size, std::uint8_t value = 7) {
    Send(frame, 3, packet, std::vector<std::uint8_t>(size, value));
  }
  void Trailer(int frame, int packet, int height) {
    std::vector<std::uint8_t> payload;
    Append(&payload, 1, 4);
    Append(&payload, static_cast<std::uint64_t>(height), 4);
    Send(frame, 2, packet, payload);
  }
  void Raw(const std::vector<std::uint8_t>& packet) {
    static_cast<void>(sendto(fd_, packet.data(), packet.size(), 0,
                             reinterpret_cast<const sockaddr*>(&to_), sizeof to_));
  }

 private:
  static void Append(std::vector<std::uint8_t>* packet, std::uint64_t value, int bytes) {
    for (int i = bytes; i-- > 0;) packet->push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  }
  void Send(int frame, std::uint64_t kind, int packet, const std::vector<std::uint8_t>& payload) {
    std::vector<std::uint8_t> bytes;
    Append(&bytes, 0, 2);  // status: well
    Append(&bytes, static_cast<std::uint64_t>(frame), 2);
    Append(&bytes, (kind << 24) | static_cast<std::uint64_t>(packet), 4);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    Raw(bytes);
  }

  const int fd_;
  sockaddr_in to_{};
};

}  // namespace visavis
