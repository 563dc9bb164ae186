#include "services/logger/channel_filter.h"

namespace visavis {
namespace {

constexpr std::size_t kMaxSeen = 10'000;  // names come from the network

}  // namespace

ChannelFilter::ChannelFilter(const std::string& include, const std::string& exclude)
    : include_(include, std::regex::optimize),
      exclude_(exclude, std::regex::optimize),
      excludes_(!exclude.empty()) {}

bool ChannelFilter::Takes(const std::string& channel) {
  const auto seen = seen_.find(channel);
  if (seen != seen_.end()) return seen->second;
  if (seen_.size() >= kMaxSeen) seen_.clear();
  const bool takes =
      std::regex_match(channel, include_) && !(excludes_ && std::regex_match(channel, exclude_));
  return seen_[channel] = takes;
}

}  // namespace visavis
