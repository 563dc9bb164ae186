#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/eventlog/event_log_writer.h"

namespace visavis {

/// Writes one message as an event at the message's own time.
template <typename Message>
void WriteMessage(const std::string& channel, const Message& message, EventLogWriter* writer) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  writer->Write(message.utime, channel, bytes.data(), bytes.size());
}

}  // namespace visavis
