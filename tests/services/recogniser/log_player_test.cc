// LogPlayer: every pair of a recording comes out once, in order, whatever becomes of its motion.
#include "services/recogniser/log_player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "common/bus/channels.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/rigs/rig_file.h"
#include "tests/services/recogniser/service_bench.h"
#include "tests/support/log_writing.h"

namespace visavis {
namespace {

constexpr int kPairs = 8;
constexpr std::int64_t kPeriod_us = 20'000;

/// When a camera pose is in the recording, by pair; in every recording a rig and kPairs pairs.
struct MotionCase {
  const char* name;
  std::function<bool(int)> has_motion;
  friend void PrintTo(const MotionCase& c, std::ostream* os) { *os << c.name; }
};

const MotionCase kMotionCases[] = {
    {"Always", [](int) { return true; }},
    {"Never", [](int) { return false; }},
    {"EndsEarly", [](int pair) { return pair < 3; }},
    {"StartsLate", [](int pair) { return pair > 4; }},
    {"HasAHole", [](int pair) { return pair < 3 || pair > 5; }},
};

class LogPlayerTest : public ::testing::TestWithParam<MotionCase> {
 protected:
  void SetUp() override {
    EventLogWriter writer(path_, EventLogWriter::Mode::kCreate);
    const RigDescription rig{TinyRig(), std::nullopt, std::nullopt};
    WriteMessage(kStereoRigChannel, ToMessage(rig, kBaseUs), &writer);
    for (int pair = 0; pair < kPairs; ++pair) {
      const std::int64_t t_us = (pair + 1) * kPeriod_us;
      WriteMessage(kStereoImagesChannel, PairAt(t_us, rig.rig), &writer);
      if (!GetParam().has_motion(pair)) continue;
      const RigidTransform X_WC =
          MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01 * pair, 0, 0));
      WriteMessage(kCameraPoseChannel, ToMessage(X_WC, kBaseUs + t_us), &writer);
    }
    writer.Close();
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "recording.lcm";
};

INSTANTIATE_TEST_SUITE_P(Motion, LogPlayerTest, ::testing::ValuesIn(kMotionCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(LogPlayerTest, HandsOutEveryPairOnceInOrder) {
  LogPlayer player(path_);
  std::vector<std::int64_t> times_us;
  while (const LogPlayer::Pair* pair = player.Next()) {
    times_us.push_back(pair->frame.utime_us - kBaseUs);
  }
  std::vector<std::int64_t> expected_us;
  for (int pair = 0; pair < kPairs; ++pair) expected_us.push_back((pair + 1) * kPeriod_us);
  EXPECT_THAT(times_us, ::testing::ElementsAreArray(expected_us));
}

TEST_P(LogPlayerTest, KnowsTheMotionBetweenPairsThatHaveIt) {
  LogPlayer player(path_);
  ASSERT_NE(player.Next(), nullptr);
  for (int i = 1; const LogPlayer::Pair* pair = player.Next(); ++i) {
    if (!GetParam().has_motion(i - 1) || !GetParam().has_motion(i)) continue;
    ASSERT_TRUE(pair->step.known) << i;
    EXPECT_NEAR(pair->step.X_C2C1.translation().x(), -0.01, 1e-9) << i;
  }
}

/// Recordings that are read as the recogniser's settings say.
class ConfiguredLogTest : public ::testing::Test {
 protected:
  /// Two pairs and their camera poses on channels of @p config, and a rig where @p with_rig.
  void Write(const RecogniserChannels& channels, bool with_rig) {
    EventLogWriter writer(path_, EventLogWriter::Mode::kReplace);
    if (with_rig) {
      WriteMessage(channels.stereo_rig, ToMessage({TinyRig(), std::nullopt, std::nullopt}, kBaseUs),
                   &writer);
    }
    for (int pair = 1; pair <= 2; ++pair) {
      const RigidTransform X_WC =
          MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01 * pair, 0, 0));
      WriteMessage(channels.camera_pose, ToMessage(X_WC, kBaseUs + pair * kPeriod_us), &writer);
      WriteMessage(channels.stereo_images, PairAt(pair * kPeriod_us, TinyRig()), &writer);
    }
    writer.Close();
  }
  /// Reads the two pairs. @return the step between them.
  CameraStep StepBetweenPairs() {
    LogPlayer player(path_, config_);
    EXPECT_NE(player.Next(), nullptr);
    const LogPlayer::Pair* second = player.Next();
    EXPECT_NE(second, nullptr);
    return second ? second->step : CameraStep{};
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "recording.lcm", rig_ = folder_ / "rig.yaml";
  RecogniserConfig config_;
};

TEST_F(ConfiguredLogTest, ChannelsOfOtherNamesAreRead) {
  config_.channels.stereo_images = "EYES";
  config_.channels.stereo_rig = "EYES_RIG";
  config_.channels.camera_pose = "EYES_POSE";
  Write(config_.channels, true);
  EXPECT_TRUE(StepBetweenPairs().known);
  EXPECT_THROW(LogPlayer{path_}, std::runtime_error);
}

TEST_F(ConfiguredLogTest, EgoMotionNoneLeavesTheRecordedMotionAside) {
  Write({}, true);
  EXPECT_GT(StepBetweenPairs().X_C2C1.translation().norm(), 0.009);
  config_.ego_motion = "none";
  EXPECT_LT(StepBetweenPairs().X_C2C1.translation().norm(), 1e-12);
}

TEST_F(ConfiguredLogTest, ARigFileStandsInWhereTheRecordingHoldsNone) {
  Write({}, false);
  EXPECT_THAT([&] { LogPlayer(path_, config_); },
              ::testing::ThrowsMessage<std::runtime_error>(::testing::AllOf(
                  ::testing::HasSubstr("STEREO_RIG"), ::testing::HasSubstr("rig_file"))));
  StereoRig rig = TinyRig();
  rig.right.fx = 81;
  SaveRigFile({rig, std::nullopt, std::nullopt}, rig_);
  config_.rig_file = rig_;
  EXPECT_EQ(LogPlayer(path_, config_).rig().right.fx, 81);
  EXPECT_TRUE(StepBetweenPairs().known);
  Write({}, true);  // its own comes first
  EXPECT_EQ(LogPlayer(path_, config_).rig().right.fx, TinyRig().right.fx);
}

}  // namespace
}  // namespace visavis
