#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace visavis {

/// Typed publish and subscribe. Live it is LcmBus; in a replay LogBus. Handlers run in the thread
/// that drives the bus; there is no other.
class Bus {
 public:
  using BytesHandler =
      std::function<void(const std::string& channel, const std::uint8_t* data, int size)>;
  using RejectHandler = std::function<void(const std::string& channel, const std::string& reason)>;

  /// @p prefix, e.g. ROBOT1_, goes before every channel's name.
  explicit Bus(std::string prefix) : prefix_(std::move(prefix)) {}
  virtual ~Bus() = default;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Encodes and sends @p message. Memory is reused from call to call.
  /// @throws std::runtime_error where sending fails.
  template <typename Message>
  void Publish(const std::string& channel, const Message& message) {
    encoded_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    if (message.encode(encoded_.data(), 0, static_cast<int>(encoded_.size())) < 0)
      FailEncoding(channel);
    PublishBytes(prefix_ + channel, encoded_.data(), static_cast<int>(encoded_.size()));
  }

  /// Calls @p handler for each message on @p channel (a literal name, A-Z0-9_) that decodes to its
  /// last byte; others go to the reject handler. The message object is reused from call to call.
  template <typename Message>
  void Subscribe(const std::string& channel, std::function<void(const Message&)> handler,
                 int queue_capacity = 30) {
    SubscribeBytes(
        prefix_ + channel,
        [this, handler = std::move(handler), message = Message{}](
            const std::string& name, const std::uint8_t* data, int size) mutable {
          const int decoded = message.decode(data, 0, size);
          if (decoded != size) {
            Reject(name, std::string("is no ") + Message::getTypeName() + " of " +
                             std::to_string(size) + " bytes");
            return;
          }
          handler(message);
        },
        queue_capacity);
  }

  /// Calls @p handler with every message on every channel (prefixed or not), not decoded.
  virtual void SubscribeAll(BytesHandler handler, int queue_capacity) = 0;

  /// Told of each message that did not decode; the process goes on.
  void set_reject_handler(RejectHandler handler) { on_reject_ = std::move(handler); }
  std::int64_t num_rejected() const { return num_rejected_; }
  const std::string& prefix() const { return prefix_; }

 protected:
  virtual void PublishBytes(const std::string& channel, const std::uint8_t* data, int size) = 0;
  virtual void SubscribeBytes(const std::string& channel, BytesHandler handler,
                              int queue_capacity) = 0;
  void Reject(const std::string& channel, const std::string& reason);

 private:
  [[noreturn]] static void FailEncoding(const std::string& channel);

  const std::string prefix_;
  std::vector<std::uint8_t> encoded_;
  RejectHandler on_reject_;
  std::int64_t num_rejected_{0};
};

}  // namespace visavis
