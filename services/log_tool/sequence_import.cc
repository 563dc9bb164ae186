#include "services/log_tool/sequence_import.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "common/bus/channels.h"
#include "common/convert/image_message.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/core/provisional_file.h"
#include "common/eventlog/event_log_writer.h"
#include "services/log_tool/picture_file.h"
#include "visavis/arm_state_t.hpp"

namespace visavis {
namespace {

constexpr std::int64_t kRigPeriodUs = 1'000'000;
constexpr std::int64_t kMaxRigs = 100'000;  // more than a day: times that leap

/// Kinds of events, in the order of those with one time.
enum class Kind { kRig, kCameraPose, kArmState, kTruth, kImages };

struct PlannedEvent {
  std::int64_t utime_us;
  Kind kind;
  std::size_t index;  ///< into the sequence's vector of this kind
};

std::vector<PlannedEvent> PlanEvents(const RecordedSequence& sequence) {
  std::vector<PlannedEvent> plan;
  const auto add = [&plan](Kind kind, std::size_t count, auto time_of) {
    for (std::size_t i = 0; i < count; ++i) plan.push_back({time_of(i), kind, i});
  };
  const auto& s = sequence;
  add(Kind::kImages, s.frames.size(), [&s](std::size_t i) { return s.frames[i].utime_us; });
  add(Kind::kCameraPose, s.camera_poses.size(),
      [&s](std::size_t i) { return s.camera_poses[i].utime_us; });
  add(Kind::kArmState, s.arm_states.size(),
      [&s](std::size_t i) { return s.arm_states[i].utime_us; });
  add(Kind::kTruth, s.truth.size(),
      [&s](std::size_t i) { return s.frames[s.truth[i].frame].utime_us; });
  const auto by_time = [](const PlannedEvent& a, const PlannedEvent& b) {
    return a.utime_us != b.utime_us ? a.utime_us < b.utime_us : a.kind < b.kind;
  };
  const auto [first, last] = std::minmax_element(plan.begin(), plan.end(), by_time);
  const std::int64_t start_us = first->utime_us, end_us = last->utime_us;
  const std::int64_t num_rigs = std::min((end_us - start_us) / kRigPeriodUs + 1, kMaxRigs);
  add(Kind::kRig, static_cast<std::size_t>(num_rigs),
      [start_us](std::size_t i) { return start_us + static_cast<std::int64_t>(i) * kRigPeriodUs; });
  std::sort(plan.begin(), plan.end(), [&by_time](const PlannedEvent& a, const PlannedEvent& b) {
    return by_time(a, b) || (!by_time(b, a) && a.index < b.index);
  });
  return plan;
}

/// Encodes the events of a sequence into a log.
class Importer {
 public:
  Importer(const RecordedSequence& sequence, const std::string& prefix, EventLogWriter* writer)
      : sequence_(sequence),
        camera_track_(sequence.camera_poses),
        prefix_(prefix),
        writer_(*writer) {
    arm_message_.num_joints = static_cast<std::int32_t>(sequence.joint_names.size());
    arm_message_.joint_names = sequence.joint_names;
    arm_message_.source = "arm.csv";
    arm_message_.clock_state = arm_state_t::CLOCK_UNKNOWN;
    arm_message_.clock_offset_s = std::nan("");
    images_message_.n_images = 2;
    images_message_.image_types = {images_t::LEFT, images_t::RIGHT};
    images_message_.images.resize(2);
  }

  void Write(const PlannedEvent& event) {
    switch (event.kind) {
      case Kind::kRig:
        return Put(event.utime_us, kStereoRigChannel, ToMessage(sequence_.rig, event.utime_us));
      case Kind::kCameraPose:
        return Put(event.utime_us, kCameraPoseChannel,
                   ToMessage(sequence_.camera_poses[event.index].X, event.utime_us));
      case Kind::kArmState:
        return WriteArmState(sequence_.arm_states[event.index], event.index);
      case Kind::kTruth:
        return WriteTruth(sequence_.truth[event.index]);
      case Kind::kImages:
        return WriteImages(sequence_.frames[event.index]);
    }
  }

 private:
  template <typename Message>
  void Put(std::int64_t utime_us, const char* channel, const Message& message) {
    encoded_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(encoded_.data(), 0, static_cast<int>(encoded_.size()));
    writer_.Write(utime_us, prefix_ + channel, encoded_.data(), encoded_.size());
  }

  void WriteArmState(const SequenceArmState& state, std::size_t index) {
    arm_message_.utime = state.utime_us;
    arm_message_.seq = static_cast<std::int64_t>(index);
    arm_message_.joint_position = state.positions;
    arm_message_.joint_velocity = state.velocities;
    Put(state.utime_us, kArmStateChannel, arm_message_);
  }

  void WriteTruth(const SequenceTruth& truth) {
    const std::int64_t utime_us = sequence_.frames[truth.frame].utime_us;
    head_pose_t message =
        TruthMessage(utime_us, static_cast<std::int64_t>(truth.frame), &truth.X_CM);
    if (const RigidTransform* X_WC = camera_track_.Find(utime_us)) {
      SetWorldPose(*X_WC * truth.X_CM, &message);
    }
    Put(utime_us, kHeadPoseTruthChannel, message);
  }

  void WriteImages(const SequenceFrame& frame) {
    images_message_.utime = frame.utime_us;
    ReadImage(frame, true, &images_message_.images[0]);
    ReadImage(frame, false, &images_message_.images[1]);
    Put(frame.utime_us, kStereoImagesChannel, images_message_);
  }

  void ReadImage(const SequenceFrame& frame, bool left, image_t* message) {
    const std::string& path = left ? frame.left : frame.right;
    const Pinhole& camera = left ? sequence_.rig.rig.left : sequence_.rig.rig.right;
    try {
      const ImageView& image =
          (left ? left_reader_ : right_reader_).Read(path, camera.width, camera.height);
      SetImage(image, frame.utime_us, message);
      AddMetadata("seq", frame.number, message);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(frame.place + (left ? ": left: " : ": right: ") +
                                  std::filesystem::path(path).filename().string() + ": " +
                                  e.what());
    }
  }

  const RecordedSequence& sequence_;
  const PoseTrack camera_track_;
  const std::string prefix_;
  EventLogWriter& writer_;
  PictureReader left_reader_, right_reader_;
  images_t images_message_{};
  arm_state_t arm_message_{};
  std::vector<std::uint8_t> encoded_;
};

}  // namespace

ImportSummary ImportSequence(const std::string& folder, const std::string& log,
                             const std::string& prefix) {
  const RecordedSequence sequence = ReadRecordedSequence(folder);
  const std::vector<PlannedEvent> plan = PlanEvents(sequence);

  ProvisionalFile file(log);
  EventLogWriter writer(file.provisional_name(), EventLogWriter::Mode::kReplace);
  Importer importer(sequence, prefix, &writer);
  for (const PlannedEvent& event : plan) importer.Write(event);
  writer.Close();
  file.Keep();

  ImportSummary summary;
  summary.num_frames = static_cast<std::int64_t>(sequence.frames.size());
  summary.num_truth = static_cast<std::int64_t>(sequence.truth.size());
  summary.num_camera_poses = static_cast<std::int64_t>(sequence.camera_poses.size());
  summary.num_arm_states = static_cast<std::int64_t>(sequence.arm_states.size());
  summary.num_bytes = writer.num_bytes();
  summary.duration_s = 1e-6 * static_cast<double>(sequence.frames.back().utime_us -
                                                  sequence.frames.front().utime_us);
  return summary;
}

}  // namespace visavis
