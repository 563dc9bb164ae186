#pragma once

#include <cstdint>
#include <exception>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.h"

namespace visavis {

/// LCM's default for us: stays on the host, and holds a stereo pair in the socket's buffer.
inline constexpr char kDefaultLcmUrl[] = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// What the kernel granted for receiving, against what the URL asked for.
struct ReceiveBuffer {
  std::int64_t asked_bytes{0};    ///< recv_buf_size of the URL; 0: not in the URL
  std::int64_t granted_bytes{0};  ///< 0: nothing subscribed yet, or not a udpm:// URL
  /// Whether less was granted than asked: large messages will be lost.
  bool too_small() const { return granted_bytes > 0 && granted_bytes < asked_bytes; }
};

/// Bus over one LCM provider. "memq://" serves unit tests.
class LcmBus final : public Bus {
 public:
  /// @throws std::runtime_error with what mends it where the provider cannot be opened (no
  /// multicast route, a malformed URL): a service that cannot reach its bus must not run.
  LcmBus(const std::string& url, const std::string& prefix);
  ~LcmBus() override;

  void SubscribeAll(BytesHandler handler, int queue_capacity) override;

  /// Readable when HandleOne() will not block; -1 while nothing is subscribed. (Asking LCM for it
  /// starts a thread that receives whatever is on the network, our own pictures too.)
  int fd() { return subscriptions_.empty() ? -1 : lcm_.getFileno(); }

  /// Handles one message, waiting at most @p timeout_ms. @return whether one was handled.
  /// An exception of the handler is rethrown here, past LCM's C frames.
  bool HandleOne(int timeout_ms);

  /// Reads back what the sockets were granted; the kernel cuts a large request without a word.
  ReceiveBuffer GetReceiveBuffer() const;

 private:
  struct Subscription {
    LcmBus* bus{};
    BytesHandler handler;
  };
  void PublishBytes(const std::string& channel, const std::uint8_t* data, int size) override;
  void SubscribeBytes(const std::string& channel, BytesHandler handler,
                      int queue_capacity) override;

  const std::string url_;
  lcm::LCM lcm_;
  std::vector<std::unique_ptr<Subscription>> subscriptions_;
  std::exception_ptr handler_error_;
};

}  // namespace visavis
