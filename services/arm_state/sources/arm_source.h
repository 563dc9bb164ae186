#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "common/bus/bus.h"
#include "common/core/clock.h"
#include "services/arm_state/joint_reading.h"

namespace visavis {

/// What a source is given. Bus and clock are aliased and outlive it.
struct SourceContext {
  Bus* bus;
  const Clock* clock;
  bool live;            ///< false: a replay, in log time
  std::string channel;  ///< to listen on, without prefix
  std::string file;     ///< to read
  /// Takes each reading, in the source's own time.
  std::function<void(const JointReading&)> take;
};

/// Where joint states come from. One class an arm; see README.md on how to add one.
class ArmSource {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  virtual ~ArmSource() = default;

  // For a source that is not driven by messages:
  /// When Wake() is due, in the clock's microseconds.
  virtual std::int64_t next_wake_us() const { return kNever; }
  virtual void Wake() {}
  /// True once nothing will come any more.
  virtual bool finished() const { return false; }
};

/// A source of messages on one channel: a driver's. What is derived from it says how to read one.
template <typename Message>
class MessageSource : public ArmSource {
 public:
  explicit MessageSource(const SourceContext& context) {
    context.bus->Subscribe<Message>(
        context.channel,
        [this, take = context.take](const Message& message) {
          Read(message, &reading_);
          take(reading_);
        },
        kQueueCapacity);
  }

 private:
  static constexpr int kQueueCapacity = 200;  // 0.2 s of a 1 kHz arm

  /// Sets all of @p reading, whose memory is reused.
  virtual void Read(const Message& message, JointReading* reading) = 0;

  JointReading reading_;
};

}  // namespace visavis
