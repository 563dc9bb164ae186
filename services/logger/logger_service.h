#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/eventlog/event_log_writer.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "services/logger/channel_filter.h"
#include "services/logger/logger_config.h"
#include "visavis/images_t.hpp"

namespace visavis {

/// Writes what is on the bus to a standard LCM event log, each message at the time it arrived.
class LoggerService final : public Service {
 public:
  static ServiceTraits Traits();

  /// Opens a new log in the folder. @throws std::runtime_error naming what cannot be written.
  LoggerService(const LoggerConfig& config, const ServiceContext& context);

  std::int64_t next_wake_us() const override { return next_flush_us_; }
  /// Hands what is buffered to the system.
  void Wake() override;
  void UpdateStatus() override;
  /// Writes what the bus still holds of the time before, and closes the log.
  void Finish() override;

  const std::string& log() const { return writer_->path(); }

 private:
  void OnMessage(const std::string& channel, const std::uint8_t* data, int size);
  bool IsUnwantedImage(const std::uint8_t* data, int size);
  void Drain();
  /// Runs @p write; a failure (a full disk) is told in the status and the logger goes on.
  template <typename Write>
  bool Guard(const Write& write);

  const LoggerConfig config_;
  const ServiceContext context_;
  ChannelFilter filter_;
  std::unique_ptr<EventLogWriter> writer_;
  images_t images_;  // memory for looking into images
  std::int64_t next_flush_us_{0};
  std::int64_t num_left_out_{0};
};

}  // namespace visavis
