#include "services/arm_state/stamp_map.h"

#include <algorithm>

namespace visavis {

void StampMap::Reset() {
  least_us_.fill(kNone);
  bucket_ = kNone;
  last_us_ = -1;
}

std::int64_t StampMap::Map(std::int64_t stamp_us, std::int64_t arrival_us) {
  std::int64_t bucket = arrival_us / kBucketUs;
  const auto size = static_cast<std::int64_t>(least_us_.size());
  // Where the host's own clock was set back, or nothing came for long, all is old.
  if (bucket_ == kNone || bucket < bucket_ - kRestartUs / kBucketUs || bucket >= bucket_ + size) {
    least_us_.fill(kNone);
  } else {
    bucket = std::max(bucket, bucket_);
    for (std::int64_t b = bucket_ + 1; b <= bucket; ++b)
      least_us_[static_cast<std::size_t>(b % size)] = kNone;
  }
  bucket_ = bucket;
  std::int64_t& least = least_us_[static_cast<std::size_t>(bucket % size)];
  least = std::min(least, arrival_us - stamp_us);
  const std::int64_t offset_us = *std::min_element(least_us_.begin(), least_us_.end());
  // A shorter way found, or the host's clock set back, must not turn the order of two stamps.
  last_us_ = last_us_ - (stamp_us + offset_us) > kRestartUs
                 ? stamp_us + offset_us
                 : std::max(last_us_ + 1, stamp_us + offset_us);
  return last_us_;
}

}  // namespace visavis
