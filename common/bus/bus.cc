#include "common/bus/bus.h"

#include <stdexcept>

namespace visavis {

void Bus::Reject(const std::string& channel, const std::string& reason) {
  ++num_rejected_;
  if (on_reject_) on_reject_(channel, reason);
}

void Bus::FailEncoding(const std::string& channel) {
  throw std::runtime_error("message for " + channel + " does not encode: array and length differ");
}

}  // namespace visavis
