#include "services/log_tool/log_info.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "common/bus/channels.h"
#include "common/eventlog/event_log.h"
#include "common/geometry/truth_track.h"
#include "visavis/arm_command_t.hpp"
#include "visavis/arm_state_t.hpp"
#include "visavis/ga_population_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/joint_state_t.hpp"
#include "visavis/recogniser_command_t.hpp"
#include "visavis/recogniser_timing_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/service_status_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {
namespace {

template <typename... Types>
std::map<std::uint64_t, std::string> NamesOf() {
  return {{static_cast<std::uint64_t>(Types::getHash()),
           std::string("visavis.") + Types::getTypeName()}...};
}

std::uint64_t FingerprintOf(const LogEvent& event) {
  std::uint64_t fingerprint = 0;
  for (std::size_t i = 0; i < 8; ++i) fingerprint = fingerprint << 8 | event.data[i];
  return fingerprint;
}

/// The utime that all our messages begin with, behind the fingerprint.
std::int64_t MessageTime(const LogEvent& event) {
  std::uint64_t utime = 0;
  for (std::size_t i = 8; i < 16; ++i) utime = utime << 8 | event.data[i];
  return static_cast<std::int64_t>(utime);
}

std::string FormatBytes(std::int64_t bytes) {
  char text[32];
  if (bytes < 10'000) {
    std::snprintf(text, sizeof text, "%lld B", static_cast<long long>(bytes));
  } else if (bytes < 10'000'000) {
    std::snprintf(text, sizeof text, "%.1f kB", 1e-3 * static_cast<double>(bytes));
  } else {
    std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
  }
  return text;
}

}  // namespace

double ChannelInfo::rate_hz() const {
  const double span_s = 1e-6 * static_cast<double>(last_us - first_us);
  return span_s > 0 ? static_cast<double>(num_events - 1) / span_s : 0;
}

std::string TypeNameOfFingerprint(std::uint64_t fingerprint) {
  static const auto* names = [] {
    auto* all = new auto(NamesOf<arm_command_t, arm_state_t, ga_population_t, head_pose_t, image_t,
                                 images_t, joint_state_t, recogniser_command_t, recogniser_timing_t,
                                 rigid_transform_t, service_status_t, stereo_rig_t>());
    all->emplace(0xf16fb804284abca3, "drake.lcmt_iiwa_status");
    all->emplace(0x19571cdf4d82fae6, "drake.lcmt_panda_status");
    return all;
  }();
  const auto found = names->find(fingerprint);
  if (found != names->end()) return found->second;
  char text[32];
  std::snprintf(text, sizeof text, "unknown %016llx", static_cast<unsigned long long>(fingerprint));
  return text;
}

LogInfo ReadLogInfo(const std::string& path, const std::string& prefix) {
  LogInfo info;
  EventLogReader reader(path);
  LogEvent event;
  std::vector<std::int64_t> image_times, pose_times;
  std::vector<TruthSample> truth;
  std::int64_t last_us = 0;
  while (reader.Next(&event)) {
    if (info.num_events++ == 0) info.first_us = info.last_us = last_us = event.utime;
    info.first_us = std::min(info.first_us, event.utime);
    info.last_us = std::max(info.last_us, event.utime);
    if (event.utime < last_us - 1'000'000) ++info.num_backward_jumps;
    last_us = event.utime;
    ChannelInfo& channel = info.channels[event.channel];
    if (channel.num_events++ == 0) channel.first_us = channel.last_us = event.utime;
    channel.first_us = std::min(channel.first_us, event.utime);
    channel.last_us = std::max(channel.last_us, event.utime);
    channel.num_bytes += static_cast<std::int64_t>(event.data.size());
    if (event.data.size() < 16) {
      channel.types.insert("none");
      continue;
    }
    channel.types.insert(TypeNameOfFingerprint(FingerprintOf(event)));
    if (event.channel == prefix + kStereoImagesChannel) image_times.push_back(MessageTime(event));
    if (event.channel == prefix + kHeadPoseChannel) pose_times.push_back(MessageTime(event));
    if (event.channel == prefix + kHeadPoseTruthChannel) {
      truth.push_back({MessageTime(event), RigidTransform::Identity(), {}});
    }
  }
  info.file_bytes = reader.file_size();
  info.num_damaged_bytes = reader.num_damaged_bytes();
  info.num_damaged_places = reader.num_damaged_places();
  info.num_truncated_bytes = reader.num_truncated_bytes();
  if (info.num_events == 0 && info.file_bytes > 0) {
    throw std::invalid_argument(path + ": must be an LCM event log, holds no event");
  }
  const auto& frames = image_times.empty() ? pose_times : image_times;
  const TruthTrack track(truth, frames);
  info.num_frames = static_cast<std::int64_t>(frames.size());
  info.num_frames_with_truth = std::count_if(
      frames.begin(), frames.end(), [&](std::int64_t utime_us) { return !!track.At(utime_us); });
  return info;
}

std::string FormatLogInfo(const std::string& path, const LogInfo& info) {
  char line[512];
  std::string text;
  const auto add = [&](auto... values) {
    std::snprintf(line, sizeof line, values...);
    text += line;
    text += '\n';
  };
  add("%s: %lld events, %s, %.3f s", path.c_str(), static_cast<long long>(info.num_events),
      FormatBytes(info.file_bytes).c_str(),
      1e-6 * static_cast<double>(info.last_us - info.first_us));
  add("%-20s %8s %9s %10s  %s", "channel", "events", "rate", "bytes", "type");
  for (const auto& [name, channel] : info.channels) {
    std::string types;
    for (const auto& type : channel.types) types += (types.empty() ? "" : ", ") + type;
    add("%-20s %8lld %6.1f Hz %10s  %s", name.c_str(), static_cast<long long>(channel.num_events),
        channel.rate_hz(), FormatBytes(channel.num_bytes).c_str(), types.c_str());
  }
  add("frames: %lld, with truth: %lld", static_cast<long long>(info.num_frames),
      static_cast<long long>(info.num_frames_with_truth));
  if (info.num_backward_jumps > 0) {
    add("time goes back by more than 1 s: %lld times",
        static_cast<long long>(info.num_backward_jumps));
  }
  if (info.num_damaged_bytes > 0) {
    add("DAMAGED: %lld bytes in %lld places%s", static_cast<long long>(info.num_damaged_bytes),
        static_cast<long long>(info.num_damaged_places),
        info.num_truncated_bytes > 0 ? ", the last of them an unfinished event at the end" : "");
  }
  return text;
}

}  // namespace visavis
