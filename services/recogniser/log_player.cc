#include "services/recogniser/log_player.h"

#include <stdexcept>
#include <utility>

#include "common/bus/channels.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"

namespace visavis {
namespace {

template <typename Message>
bool Decode(const LogEvent& event, const char* channel, Message* message) {
  const int size = static_cast<int>(event.data.size());
  return event.channel == channel && message->decode(event.data.data(), 0, size) == size;
}

}  // namespace

LogPlayer::LogPlayer(const std::string& path) : reader_(path) { ReadRig(); }

void LogPlayer::ReadRig() {
  stereo_rig_t message;
  while (reader_.Next(&event_)) {
    if (!Decode(event_, kStereoRigChannel, &message)) continue;
    const RigDescription description = FromMessage(message);
    rig_ = description.rig;
    motion_.SetRig(description);
    preparer_ = std::make_unique<FramePreparer>(rig_);
    reader_.Rewind();
    return;
  }
  throw std::runtime_error(reader_.path() + ": holds no " + kStereoRigChannel);
}

bool LogPlayer::ReadUntilReady() {
  if (later_images_) {
    images_ = std::move(*later_images_);
    later_images_.reset();
    has_images_ = true;
    if (motion_.IsCertainAt(images_.utime)) return true;
  }
  arm_state_t arm;
  rigid_transform_t camera;
  head_pose_t truth;
  images_t images;
  while (reader_.Next(&event_)) {
    if (Decode(event_, kHeadPoseTruthChannel, &truth)) {
      if (HasPose(truth)) truths_[truth.utime] = FromMessage(truth);
    } else if (Decode(event_, kArmStateChannel, &arm)) {
      motion_.AddArmState(arm.utime, arm.joint_names, arm.joint_position, arm.joint_velocity);
    } else if (Decode(event_, kCameraPoseChannel, &camera)) {
      motion_.AddCameraPose(camera.utime, FromMessage(camera));
    } else if (Decode(event_, kStereoImagesChannel, &images)) {
      if (has_images_) {  // no motion came in time: the pair goes on with what is known
        later_images_ = std::move(images);
        return true;
      }
      images_ = std::move(images);
      has_images_ = true;
    }
    if (has_images_ && motion_.IsCertainAt(images_.utime)) return true;
  }
  return has_images_;
}

const LogPlayer::Pair* LogPlayer::Next() {
  if (!ReadUntilReady()) return nullptr;
  has_images_ = false;
  pair_.frame = preparer_->Prepare(FromMessage(images_, rig_));
  pair_.step = last_utime_us_ ? motion_.Between(*last_utime_us_, images_.utime) : CameraStep{};
  last_utime_us_ = images_.utime;
  const auto truth = truths_.find(images_.utime);
  pair_.truth = truth == truths_.end() ? std::nullopt : std::optional(truth->second);
  truths_.erase(truths_.begin(), truths_.upper_bound(images_.utime - 1'000'000));
  return &pair_;
}

}  // namespace visavis
