#include "services/simulator/simulator_service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "common/bus/channels.h"
#include "common/bus/log_bus.h"
#include "common/convert/decode_event.h"
#include "common/convert/image_message.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/kinematics/hand_eye.h"
#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"
#include "common/service/offline_loop.h"
#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/rigid_transform_t.hpp"

namespace visavis {
namespace {

/// A small rig on the demo's arm, so that pictures cost little.
std::string SmallRig(const TemporaryFolder& folder) {
  RigDescription rig = DemoRig();
  rig.rig.right = rig.rig.left = {160, 120, 200, 200, 79.5, 59.5, {}};
  SaveRigFile(rig, folder / "rig.yaml");
  return folder / "rig.yaml";
}

struct Recording {
  std::vector<LogEvent> events;

  std::vector<LogEvent> On(const std::string& channel) const {
    std::vector<LogEvent> result;
    for (const LogEvent& event : events) {
      if (event.channel == channel) result.push_back(event);
    }
    return result;
  }
};

template <typename Message>
Message Decode(const LogEvent& event) {
  Message message;
  EXPECT_TRUE(DecodeEvent(event, &message)) << event.channel;
  return message;
}

class SimulatorServiceTest : public ::testing::Test {
 protected:
  SimulatorServiceTest() {
    config_.rig_file = SmallRig(folder_);
    config_.scene.texture_size = 64;
    config_.seconds = 0.5;
  }

  Recording Run(const std::string& name = "out.lcm") const {
    ManualClock clock;
    StatusReporter status("simulator", "0");
    EventLogWriter writer(folder_ / name, EventLogWriter::Mode::kReplace);
    LogBus bus("", &clock, &writer);
    SimulatorService service(config_, {&bus, &clock, &status, false});
    RunFast(&service, &clock, &status, stop_);
    writer.Close();
    EXPECT_EQ(status.rejected(), 0) << status.last_error();
    Recording recording;
    EventLogReader reader(folder_ / name);
    for (LogEvent event; reader.Next(&event);) recording.events.push_back(event);
    return recording;
  }

  const TemporaryFolder folder_;
  const StopSignal stop_;
  SimulatorConfig config_;
};

TEST_F(SimulatorServiceTest, WritesEveryChannelAtItsRate) {
  config_.publish_camera_pose = true;
  const Recording recording = Run();
  EXPECT_EQ(recording.On(kStereoImagesChannel).size(), 15u);
  EXPECT_EQ(recording.On(kHeadPoseTruthChannel).size(), 15u);
  EXPECT_EQ(recording.On(kCameraPoseChannel).size(), 15u);
  EXPECT_NEAR(static_cast<double>(recording.On(kArmStateChannel).size()), 200 * 0.5, 6);
  EXPECT_EQ(recording.On(kStereoRigChannel).size(), 1u);
  EXPECT_EQ(recording.events.front().channel, kStereoRigChannel);
}

TEST_F(SimulatorServiceTest, SameConfigurationSameBytes) {
  config_.seconds = 0.2;
  const Recording first = Run("a.lcm"), second = Run("b.lcm");
  ASSERT_EQ(first.events.size(), second.events.size());
  for (std::size_t i = 0; i < first.events.size(); ++i) {
    EXPECT_EQ(first.events[i].utime, second.events[i].utime);
    EXPECT_EQ(first.events[i].data, second.events[i].data) << first.events[i].channel;
  }
  config_.seed = 2;
  EXPECT_NE(Run("c.lcm").On(kStereoImagesChannel).front().data,
            first.On(kStereoImagesChannel).front().data);
}

TEST_F(SimulatorServiceTest, TruthIsForwardKinematicsOfTheArmStatesToTheHead) {
  config_.frame_rate_hz = 20;  // each exposure coincides with an arm state
  const Recording recording = Run();
  std::map<std::int64_t, arm_state_t> states;
  for (const LogEvent& event : recording.On(kArmStateChannel)) {
    const auto state = Decode<arm_state_t>(event);
    states[state.utime] = state;
  }
  const auto rig = FromMessage(Decode<stereo_rig_t>(recording.On(kStereoRigChannel).front()));
  const HandEye hand_eye(Arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link), rig.arm->X_WB,
                         *rig.X_HC);
  std::optional<RigidTransform> X_WM;
  for (const LogEvent& event : recording.On(kHeadPoseTruthChannel)) {
    const auto truth = Decode<head_pose_t>(event);
    const arm_state_t& state = states.at(truth.utime);
    const RigidTransform X_WC = hand_eye.CameraPose(Eigen::Map<const Eigen::VectorXd>(
        state.joint_position.data(), static_cast<Eigen::Index>(state.joint_position.size())));
    const RigidTransform X = X_WC * FromMessage(truth);
    if (X_WM) {
      EXPECT_LT((X.matrix() - X_WM->matrix()).cwiseAbs().maxCoeff(), 1e-9);  // the head rests
    }
    X_WM = X;
  }
}

TEST_F(SimulatorServiceTest, ArmStatesPrecedeTheImagesAndReachBeyondTheirExposure) {
  const Recording recording = Run();
  std::int64_t newest_arm_us = -1, last_log_us = 0;
  for (const LogEvent& event : recording.events) {
    EXPECT_GE(event.utime, last_log_us);
    last_log_us = event.utime;
    if (event.channel == kArmStateChannel) {
      newest_arm_us = Decode<arm_state_t>(event).utime;
      EXPECT_EQ(event.utime, newest_arm_us);  // each in its own time, not in bursts
    }
    if (event.channel != kStereoImagesChannel) continue;
    const auto images = Decode<images_t>(event);
    EXPECT_EQ(event.utime - images.utime, 6000);  // readout_ms
    EXPECT_GE(newest_arm_us, images.utime);
  }
}

TEST_F(SimulatorServiceTest, ImagesCarryNumberExposureAndSkew) {
  const Recording recording = Run();
  const auto rig = FromMessage(Decode<stereo_rig_t>(recording.On(kStereoRigChannel).front()));
  std::int64_t seq = 0;
  for (const LogEvent& event : recording.On(kStereoImagesChannel)) {
    const auto images = Decode<images_t>(event);
    const StereoImages pair = FromMessage(images, rig.rig);
    EXPECT_TRUE(pair.right && pair.left);
    EXPECT_EQ(pair.right->format, PixelFormat::kRgb);
    for (const image_t& image : images.images) {
      EXPECT_EQ(FindMetadata(image, "seq"), seq);
      EXPECT_EQ(FindMetadata(image, "exposure_us"), 8000);
      EXPECT_EQ(FindMetadata(image, "skew_us"), 0);
    }
    ++seq;
  }
}

TEST_F(SimulatorServiceTest, JpegIsAMatterOfConfiguration) {
  config_.seconds = 0.1;
  config_.image_format = "jpeg";
  const auto images = Decode<images_t>(Run().On(kStereoImagesChannel).front());
  EXPECT_EQ(FromMessage(images.images[0]).format, PixelFormat::kJpeg);
  ImageDecoder decoder;
  EXPECT_EQ(decoder.Decode(FromMessage(images.images[0])).width, 160);
}

TEST_F(SimulatorServiceTest, GrayPicturesAreAsBrightAsColouredOnes) {
  config_.seconds = 0.1;
  const auto coloured = Decode<images_t>(Run().On(kStereoImagesChannel).front());
  config_.image_format = "gray";
  const auto gray = Decode<images_t>(Run().On(kStereoImagesChannel).front());
  const ImageView rgb = FromMessage(coloured.images[1]), levels = FromMessage(gray.images[1]);
  ASSERT_EQ(levels.format, PixelFormat::kGray);
  ASSERT_EQ(levels.width, rgb.width);
  for (int x = 0; x < rgb.width; ++x) {
    const std::uint8_t* p = rgb.row(60) + std::ptrdiff_t{3} * x;
    EXPECT_NEAR(levels.row(60)[x], 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2], 1) << x;
  }
}

TEST_F(SimulatorServiceTest, WithoutArmTheRigDoesNotSpeakOfOne) {
  config_.publish_arm = false;
  const Recording recording = Run();
  EXPECT_TRUE(recording.On(kArmStateChannel).empty());
  const auto rig = FromMessage(Decode<stereo_rig_t>(recording.On(kStereoRigChannel).front()));
  EXPECT_FALSE(rig.arm);
  EXPECT_FALSE(rig.X_HC);
  EXPECT_EQ(recording.On(kStereoImagesChannel).size(), 15u);
}

TEST_F(SimulatorServiceTest, TruthIsNanWhileTheHeadIsAwayOrOutOfView) {
  config_.seconds = 1;
  config_.scenario.name = "static";
  config_.scenario.absent_from_s = 0.5;
  config_.scenario.absent_until_s = 0.8;
  config_.scenario.leave_s = 0.2;
  int with = 0, without = 0;
  for (const LogEvent& event : Run().On(kHeadPoseTruthChannel)) {
    const auto truth = Decode<head_pose_t>(event);
    const double t = 1e-6 * static_cast<double>(truth.utime - 1'000'000'000'000'000);
    EXPECT_TRUE(t > 0.3 || HasPose(truth)) << t;
    EXPECT_FALSE(t > 0.47 && t < 0.81 && HasPose(truth)) << t;
    (HasPose(truth) ? with : without)++;
  }
  EXPECT_GT(with, 10);
  EXPECT_GT(without, 8);
}

TEST_F(SimulatorServiceTest, AnExportedHeadIsAllUnlessAskedForMore) {
  config_.export_mesh = folder_ / "head.obj";
  config_.seconds = 0;
  EXPECT_TRUE(Run().events.empty());
  EXPECT_GT(std::filesystem::file_size(config_.export_mesh), 1000u);
  config_.seconds = 0.2;
  EXPECT_FALSE(Run().On(kStereoImagesChannel).empty());
}

TEST_F(SimulatorServiceTest, RefusesARigWithoutAnArm) {
  RigDescription rig = DemoRig();
  rig.arm.reset();
  rig.X_HC.reset();
  SaveRigFile(rig, config_.rig_file);
  EXPECT_THROW(Run(), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
