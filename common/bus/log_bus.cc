#include "common/bus/log_bus.h"

#include <stdexcept>
#include <utility>

namespace visavis {

LogBus::LogBus(const std::string& prefix, const Clock* clock, EventLogWriter* writer)
    : Bus(prefix), clock_(*clock), writer_(writer) {}

bool LogBus::Dispatch(const LogEvent& event) {
  const int size = static_cast<int>(event.data.size());
  for (auto& handler : all_handlers_) handler(event.channel, event.data.data(), size);
  const auto subscribed = handlers_.find(event.channel);
  if (subscribed == handlers_.end()) return !all_handlers_.empty();
  for (auto& handler : subscribed->second) handler(event.channel, event.data.data(), size);
  return true;
}

void LogBus::PublishBytes(const std::string& channel, const std::uint8_t* data, int size) {
  if (!writer_) return;
  try {
    writer_->Write(clock_.NowUs(), channel, data, static_cast<std::size_t>(size));
  } catch (const std::runtime_error& e) {
    throw RecordError(e.what());
  }
}

void LogBus::SubscribeBytes(const std::string& channel, BytesHandler handler, int) {
  handlers_[channel].push_back(std::move(handler));
}

void LogBus::SubscribeAll(BytesHandler handler, int) {
  all_handlers_.push_back(std::move(handler));
}

}  // namespace visavis
