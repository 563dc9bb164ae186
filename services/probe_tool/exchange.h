#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/bus/bus.h"
#include "visavis/image_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {

/// How many numbered messages of one sender came, of those that were sent meanwhile.
struct Reception {
  std::int64_t received{0};
  std::int64_t first_seq{-1}, last_seq{-1};

  /// Numbers count up; one that comes again or late is not counted twice.
  void Add(std::int64_t seq);
  /// Messages sent from the first to the last that came.
  std::int64_t sent() const { return last_seq < 0 ? 0 : last_seq - first_seq + 1; }
};

/// Tells every other participant on a bus "I am NAME", in small messages and in some as large as a
/// JPEG picture, which travel in fragments; and counts what it hears from the others.
class Exchange {
 public:
  static constexpr int kLargeBytes = 100'000;
  static constexpr char kSmallChannel[] = "PROBE_SMALL", kLargeChannel[] = "PROBE_LARGE";

  struct Peer {
    Reception small, large;
  };

  /// Subscribes on @p bus (aliased). @p name is not empty and differs from the others'.
  Exchange(Bus* bus, std::string name);

  /// Sends the next message of each size.
  void Send();

  /// By name; of each that was heard.
  const std::map<std::string, Peer>& peers() const { return peers_; }

 private:
  Bus& bus_;
  const std::string name_;
  service_status_t small_{};
  image_t large_{};
  std::int64_t seq_{0};
  std::map<std::string, Peer> peers_;
};

}  // namespace visavis
