#include "common/bus/lcm_bus.h"

#include <dirent.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <climits>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace visavis {
namespace {

std::int64_t UrlNumber(const std::string& url, const std::string& name) {
  const auto at = url.find(name + "=");
  return at == std::string::npos ? 0 : std::atoll(url.c_str() + at + name.size() + 1);
}

// Port of udpm://GROUP:PORT?...; 0: not a udpm URL. LCM's default is 7667.
int UrlPort(const std::string& url) {
  const std::string scheme = "udpm://";
  if (url.rfind(scheme, 0) != 0) return 0;
  const auto colon = url.find(':', scheme.size()), query = url.find('?');
  if (colon == std::string::npos || colon > query) return 7667;
  return std::atoi(url.c_str() + colon + 1);
}

}  // namespace

LcmBus::LcmBus(const std::string& url, const std::string& prefix)
    : Bus(prefix), url_(url), lcm_(url) {
  if (lcm_.good()) return;
  std::string message = "cannot open LCM url '" + url + "'";
  if (UrlPort(url) > 0) {
    message +=
        ": is there a multicast route? 'sudo ip route add 224.0.0.0/4 dev lo' makes one on this "
        "host";
  }
  throw std::runtime_error(message);
}

LcmBus::~LcmBus() = default;

bool LcmBus::HandleOne(int timeout_ms) {
  const bool handled = lcm_.handleTimeout(timeout_ms) > 0;
  if (handler_error_) std::rethrow_exception(std::exchange(handler_error_, nullptr));
  return handled;
}

void LcmBus::PublishBytes(const std::string& channel, const std::uint8_t* data, int size) {
  if (lcm_.publish(channel, data, static_cast<unsigned>(size)) != 0) {
    throw std::runtime_error("LCM publish failed on " + channel + ", " + std::to_string(size) +
                             " bytes");
  }
}

void LcmBus::SubscribeBytes(const std::string& channel, BytesHandler handler, int queue_capacity) {
  subscriptions_.push_back(std::make_unique<Subscription>(Subscription{this, std::move(handler)}));
  auto* native = lcm_.subscribeFunction<Subscription*>(
      channel,
      +[](const lcm::ReceiveBuffer* buffer, const std::string& name, Subscription* s) {
        try {
          // A datagram without NUL reaches us with a size near 2^32.
          if (buffer->data_size > static_cast<std::uint32_t>(INT_MAX)) {
            s->bus->Reject(name, "has an impossible size");
            return;
          }
          s->handler(name, static_cast<const std::uint8_t*>(buffer->data),
                     static_cast<int>(buffer->data_size));
        } catch (...) {
          s->bus->handler_error_ = std::current_exception();
        }
      },
      subscriptions_.back().get());
  if (!native) throw std::runtime_error("LCM subscribe failed on " + channel);
  native->setQueueCapacity(queue_capacity);
}

void LcmBus::SubscribeAll(BytesHandler handler, int queue_capacity) {
  SubscribeBytes(".*", std::move(handler), queue_capacity);
}

ReceiveBuffer LcmBus::GetReceiveBuffer() const {
  ReceiveBuffer result;
  result.asked_bytes = UrlNumber(url_, "recv_buf_size");
  const int port = UrlPort(url_);
  DIR* directory = port > 0 ? opendir("/proc/self/fd") : nullptr;
  if (!directory) return result;
  // LCM keeps its sockets to itself; ours is the one bound to the group's port.
  while (const dirent* entry = readdir(directory)) {
    const int fd = std::atoi(entry->d_name);
    sockaddr_in address{};
    socklen_t length = sizeof address;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) continue;
    if (address.sin_family != AF_INET || ntohs(address.sin_port) != port) continue;
    int bytes = 0;
    length = sizeof bytes;
    if (getsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, &length) != 0) continue;
    result.granted_bytes = bytes / 2;  // Linux reports twice what it granted
  }
  closedir(directory);
  return result;
}

}  // namespace visavis
