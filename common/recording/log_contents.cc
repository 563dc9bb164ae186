#include "common/recording/log_contents.h"

#include <stdexcept>

#include "common/bus/channels.h"
#include "common/convert/decode_event.h"
#include "common/convert/message_error.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/eventlog/event_log.h"

namespace visavis {
namespace {

template <typename Message>
const Message& Decode(const LogEvent& event, Message* message) {
  if (!DecodeEvent(event, message)) {
    throw MessageError(std::string("is no ") + Message::getTypeName());
  }
  return *message;
}

TruthSample ToSample(const head_pose_t& message) {
  TruthSample sample{message.utime, {}, {}};
  if (HasPose(message)) sample.X_CM = FromMessage(message);
  if (sample.X_CM && message.has_world_pose) {
    sample.X_WM = ReadTransform("X_WM", message.p_WM_m, message.q_WM_wxyz);
  }
  return sample;
}

}  // namespace

LogContents ReadLog(const std::string& path, const std::string& prefix,
                    const std::function<void(const images_t&)>& on_images) {
  LogContents contents;
  images_t images{};
  stereo_rig_t rig{};
  rigid_transform_t pose{};
  arm_state_t arm{};
  head_pose_t head{};
  recogniser_timing_t timing{};
  const auto take = [&](const LogEvent& event) {
    if (event.channel.compare(0, prefix.size(), prefix) != 0) return;
    const std::string channel = event.channel.substr(prefix.size());
    if (channel == kStereoImagesChannel) {
      if (on_images) on_images(Decode(event, &images));
    } else if (channel == kStereoRigChannel) {
      if (!contents.rig) contents.rig = FromMessage(Decode(event, &rig));
    } else if (channel == kCameraPoseChannel) {
      contents.camera_poses.push_back({Decode(event, &pose).utime, FromMessage(pose)});
    } else if (channel == kArmStateChannel) {
      contents.arm_states.push_back(Decode(event, &arm));
    } else if (channel == kHeadPoseTruthChannel) {
      contents.truth.push_back(ToSample(Decode(event, &head)));
    } else if (channel == kHeadPoseChannel) {
      contents.head_poses.push_back(Decode(event, &head));
    } else if (channel == kRecogniserTimingChannel) {
      contents.timings.push_back(Decode(event, &timing));
    }
  };

  EventLogReader reader(path);
  LogEvent event;
  while (reader.Next(&event)) {
    try {
      take(event);
    } catch (const std::invalid_argument& e) {
      ++contents.num_rejected;
      contents.last_reject = event.channel + ": " + e.what();
    }
  }
  contents.num_events = reader.num_events();
  contents.num_damaged_bytes = reader.num_damaged_bytes();
  if (contents.num_events == 0)
    throw std::invalid_argument(path + ": must be an LCM event log, holds no event");
  return contents;
}

}  // namespace visavis
