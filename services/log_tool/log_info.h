#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace visavis {

/// One channel of a log.
struct ChannelInfo {
  std::int64_t num_events{0};
  std::int64_t num_bytes{0};  ///< of the messages
  std::int64_t first_us{0}, last_us{0};
  std::set<std::string> types;  ///< by fingerprint, e.g. "visavis.head_pose_t"

  /// Mean rate over the channel's own span; 0 where it has none.
  double rate_hz() const;
};

/// What a log holds.
struct LogInfo {
  std::map<std::string, ChannelInfo> channels;
  std::int64_t num_events{0};
  std::int64_t file_bytes{0};
  std::int64_t first_us{0}, last_us{0};   ///< earliest and latest event
  std::int64_t num_backward_jumps{0};     ///< events more than 1 s before the one ahead of them
  std::int64_t num_frames_with_truth{0};  ///< stereo pairs, or HEAD_POSE in a log without images
  std::int64_t num_frames{0};
  std::int64_t num_damaged_bytes{0}, num_damaged_places{0}, num_truncated_bytes{0};
};

/// @throws std::runtime_error where the file cannot be read, std::invalid_argument where it holds
/// bytes but no event.
LogInfo ReadLogInfo(const std::string& path, const std::string& prefix);

/// As text for a terminal of 80 columns.
std::string FormatLogInfo(const std::string& path, const LogInfo& info);

/// Name of the type with this fingerprint: ours (of types that are equal to one of bot_core's too),
/// Drake's arm states, else "unknown 0123456789abcdef".
std::string TypeNameOfFingerprint(std::uint64_t fingerprint);

}  // namespace visavis
