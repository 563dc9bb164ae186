#include "services/probe_tool/exchange.h"

#include <utility>

namespace visavis {

void Reception::Add(std::int64_t seq) {
  if (seq < 0 || seq <= last_seq) return;
  if (first_seq < 0) first_seq = seq;
  last_seq = seq;
  ++received;
}

Exchange::Exchange(Bus* bus, std::string name) : bus_(*bus), name_(std::move(name)) {
  small_.service = "probe";
  small_.host = name_;
  large_.size = kLargeBytes;
  large_.data.resize(kLargeBytes);
  large_.nmetadata = 1;
  large_.metadata.resize(1);
  large_.metadata[0].key = name_;
  bus_.Subscribe<service_status_t>(
      kSmallChannel,
      [this](const service_status_t& m) {
        if (m.host != name_) peers_[m.host].small.Add(m.processed);
      },
      1000);
  bus_.Subscribe<image_t>(
      kLargeChannel,
      [this](const image_t& m) {
        if (m.nmetadata == 1 && m.metadata[0].key != name_)
          peers_[m.metadata[0].key].large.Add(m.utime);
      },
      100);
}

void Exchange::Send() {
  small_.processed = seq_;
  large_.utime = seq_;
  ++seq_;
  bus_.Publish(kSmallChannel, small_);
  bus_.Publish(kLargeChannel, large_);
}

}  // namespace visavis
