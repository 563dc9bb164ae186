#pragma once

#include "common/eventlog/event_log.h"

namespace visavis {

/// Decodes an event's message into @p message, whose memory is reused. @return whether its bytes
/// are one message of this type, to the last byte; else *message is unspecified.
template <typename Message>
bool DecodeEvent(const LogEvent& event, Message* message) {
  const int size = static_cast<int>(event.data.size());
  return message->decode(event.data.data(), 0, size) == size;
}

}  // namespace visavis
