#include "services/recogniser/log_player.h"

#include <stdexcept>
#include <utility>

#include "common/bus/channels.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/rigs/rig_file.h"

namespace visavis {
namespace {

template <typename Message>
bool Decode(const LogEvent& event, const std::string& channel, Message* message) {
  const int size = static_cast<int>(event.data.size());
  return event.channel == channel && message->decode(event.data.data(), 0, size) == size;
}

}  // namespace

LogPlayer::LogPlayer(const std::string& path, const RecogniserConfig& config)
    : channels_(config.channels),
      reader_(path),
      motion_(EgoMotion::ParseChoice(config.ego_motion)) {
  ReadRig(config.rig_file);
}

void LogPlayer::ReadRig(const std::string& rig_file) {
  stereo_rig_t message;
  while (reader_.Next(&event_)) {
    if (!Decode(event_, channels_.stereo_rig, &message)) continue;
    SetRig(FromMessage(message));
    reader_.Rewind();
    return;
  }
  if (rig_file.empty()) {
    throw std::runtime_error(reader_.path() + ": holds no " + channels_.stereo_rig +
                             ", and rig_file names none");
  }
  SetRig(LoadRigFile(rig_file));
  reader_.Rewind();
}

void LogPlayer::SetRig(const RigDescription& rig) {
  rig_ = rig.rig;
  motion_.SetRig(rig);
  preparer_ = std::make_unique<FramePreparer>(rig_);
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
    } else if (Decode(event_, channels_.arm_state, &arm)) {
      motion_.AddArmState(arm.utime, arm.joint_names, arm.joint_position, arm.joint_velocity);
    } else if (Decode(event_, channels_.camera_pose, &camera)) {
      motion_.AddCameraPose(camera.utime, FromMessage(camera));
    } else if (Decode(event_, channels_.stereo_images, &images)) {
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
