// A Drake-shaped IIWA_STATUS stream drives the recogniser's feedforward: visavis-arm-state stands
// between, in a replay and live.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <map>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/core/clock.h"
#include "common/eventlog/event_log.h"
#include "common/eventlog/event_log_writer.h"
#include "tests/support/child_process.h"
#include "tests/support/environment.h"
#include "tests/support/network.h"
#include "tests/support/temporary_folder.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/iiwa_status_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/service_status_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::Each;
using ::testing::HasSubstr;

std::string Program(const std::string& name) {
  return Environment("VISAVIS_BIN_DIR") + "/visavis-" + name;
}

std::string RunWell(const std::vector<std::string>& args) {
  const ProcessResult result = RunProcess(args, {}, 2min);
  EXPECT_EQ(result.exit_code, 0) << args[0] << ": " << result.err;
  return result.out;
}

template <typename Message>
Message Decode(const LogEvent& event) {
  Message message{};
  const int size = static_cast<int>(event.data.size());
  EXPECT_EQ(message.decode(event.data.data(), 0, size), size) << event.channel;
  return message;
}

template <typename Message>
LogEvent Encode(std::int64_t utime, const std::string& channel, const Message& message) {
  LogEvent event{0, utime, channel, {}};
  event.data.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
  return event;
}

std::vector<LogEvent> ReadLog(const std::string& path) {
  EventLogReader reader(path);
  std::vector<LogEvent> events;
  for (LogEvent event; reader.Next(&event);) events.push_back(event);
  return events;
}

/// As Drake's driver would have told the same state.
iiwa_status_t AsIiwa(const arm_state_t& state) {
  iiwa_status_t m{};
  m.utime = state.utime;
  m.num_joints = state.num_joints;
  m.joint_position_measured = state.joint_position;
  m.joint_velocity_estimated = state.joint_velocity;
  m.joint_position_commanded = m.joint_position_ipo = state.joint_position;
  m.joint_torque_measured = m.joint_torque_commanded = m.joint_torque_external =
      std::vector<double>(static_cast<std::size_t>(state.num_joints), 0.0);
  return m;
}

/// Two seconds of the simulator: its arm swings to and fro in 3 s before a head at rest.
class ArmStateProcessTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    // JPEG: small enough for any socket's buffer.
    RunWell({Program("simulator"), "--fast", "--record", *folder_ / "simulated.lcm", "--scenario",
             "shuttle_x", "--period", "3", "--seconds", "2", "--set", "scene.texture_size=512",
             "--set", "scene.edge_samples=1", "--set", "image_format=jpeg", "--set",
             "jpeg_quality=60"});
    EventLogWriter writer(*folder_ / "iiwa.lcm", EventLogWriter::Mode::kReplace);
    for (LogEvent event : ReadLog(*folder_ / "simulated.lcm")) {
      if (event.channel == kArmStateChannel)
        event = Encode(event.utime, "IIWA_STATUS", AsIiwa(Decode<arm_state_t>(event)));
      writer.Write(event.utime, event.channel, event.data.data(), event.data.size());
    }
    writer.Close();
  }
  static void TearDownTestSuite() { delete folder_; }

  struct Run {
    std::vector<LogEvent> messages;  ///< HEAD_POSE as it was sent
    std::vector<head_pose_t> poses;
  };
  /// A recogniser's replay of @p log.
  static Run Recognise(const std::string& log) {
    RunWell({Program("recogniser"), "--replay", log, "--record", log + ".out"});
    Run run;
    for (const LogEvent& event : ReadLog(log + ".out")) {
      if (event.channel != kHeadPoseChannel) continue;
      run.messages.push_back(event);
      run.poses.push_back(Decode<head_pose_t>(event));
    }
    return run;
  }
  static std::vector<int> Sources(const std::vector<head_pose_t>& poses) {
    std::vector<int> sources;
    for (const head_pose_t& pose : poses) sources.push_back(pose.feedforward_source);
    return sources;
  }
  /// Position error over the second half, a constant offset removed: the model's origin is not the
  /// simulator's.
  static double RmsMm(const Run& run) {
    std::vector<Eigen::Vector3d> errors;
    std::size_t pair = 0;
    for (const LogEvent& event : ReadLog(*folder_ / "simulated.lcm")) {
      if (event.channel != kHeadPoseTruthChannel) continue;
      const auto truth = Decode<head_pose_t>(event);
      const head_pose_t& pose = run.poses.at(pair++);
      EXPECT_EQ(pose.utime, truth.utime);
      if (pair <= 30) continue;
      EXPECT_EQ(pose.status, head_pose_t::STATUS_TRACKING);
      errors.push_back(Eigen::Map<const Eigen::Vector3d>(pose.p_CM_m) -
                       Eigen::Map<const Eigen::Vector3d>(truth.p_CM_m));
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& error : errors) mean += error / static_cast<double>(errors.size());
    double sum = 0;
    for (const auto& error : errors) sum += (error - mean).squaredNorm();
    return 1e3 * std::sqrt(sum / static_cast<double>(errors.size()));
  }
  /// The log of IIWA_STATUS with the ARM_STATE that visavis-arm-state makes of it.
  static std::string MakeArmStates(const std::vector<std::string>& flags, const std::string& name) {
    const std::string out = *folder_ / name;
    std::vector<std::string> args = {Program("arm-state"),  "--source", "iiwa", "--replay",
                                     *folder_ / "iiwa.lcm", "--record", out,    "--keep-images"};
    args.insert(args.end(), flags.begin(), flags.end());
    RunWell(args);
    return out;
  }
  static TemporaryFolder* folder_;
};

TemporaryFolder* ArmStateProcessTest::folder_ = nullptr;

TEST_F(ArmStateProcessTest, ItsArmStatesGiveThePosesOfTheSimulatorsOwnByteForByte) {
  const Run own = Recognise(*folder_ / "simulated.lcm");
  const Run made = Recognise(MakeArmStates({}, "made.lcm"));
  ASSERT_EQ(made.poses.size(), 60u);
  ASSERT_EQ(own.poses.size(), 60u);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(made.messages[i].data, own.messages[i].data) << i;
  EXPECT_THAT(Sources(made.poses), Each(int{head_pose_t::SOURCE_ARM}));
  EXPECT_LT(RmsMm(made), 1);
}

TEST_F(ArmStateProcessTest, WithoutItFeedforwardIsMissing) {
  const Run run = Recognise(*folder_ / "iiwa.lcm");
  EXPECT_THAT(Sources(run.poses), Each(int{head_pose_t::SOURCE_MISSING}));
}

// The first state comes with the second reading, behind the first pair. The errors differ by less
// than a fifth of what they are.
TEST_F(ArmStateProcessTest, VelocitiesFromPositionsAndMappedTimesServeAsWell) {
  const Run own = Recognise(*folder_ / "simulated.lcm");
  Run made = Recognise(
      MakeArmStates({"--set", "velocities=differentiated", "--set", "times=mapped"}, "diff.lcm"));
  EXPECT_NEAR(RmsMm(made), RmsMm(own), 0.2 * RmsMm(own));
  made.poses.erase(made.poses.begin());
  EXPECT_THAT(Sources(made.poses), Each(int{head_pose_t::SOURCE_ARM}));
}

// Live: arm states and recogniser as processes, the test as the cameras and Drake's driver.
TEST_F(ArmStateProcessTest, LiveItFeedsARunningRecogniser) {
  if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
  const std::string url = TestLcmUrl();
  LcmBus bus(url, "");
  std::vector<head_pose_t> poses;
  service_status_t status{};
  std::map<std::string, int> statuses;
  bus.Subscribe<head_pose_t>(kHeadPoseChannel, [&](const head_pose_t& m) { poses.push_back(m); });
  bus.Subscribe<service_status_t>(kServiceStatusChannel, [&](const service_status_t& m) {
    ++statuses[m.service];
    if (m.service == "arm_state") status = m;
  });
  const auto handle_until = [&](const std::function<bool()>& condition,
                                std::chrono::milliseconds limit) {
    const auto deadline = std::chrono::steady_clock::now() + limit;
    while (!condition() && std::chrono::steady_clock::now() < deadline) bus.HandleOne(5);
    return condition();
  };
  const ChildProcess arm({Program("arm-state"), "--source", "iiwa", "--lcm-url", url});
  const ChildProcess recogniser({Program("recogniser"), "--lcm-url", url});
  ASSERT_TRUE(handle_until([&] { return statuses["arm_state"] && statuses["recogniser"]; }, 10s));

  // Pictures are cut to every third: this machine may be slow, and this test is about the arm.
  const auto events = ReadLog(*folder_ / "iiwa.lcm");
  const SystemClock clock;
  const std::int64_t shift_us = clock.NowUs() + 50'000 - events[0].utime;
  int num_pairs = 0;
  for (LogEvent event : events) {
    const std::int64_t due_us = event.utime + shift_us;
    handle_until([&] { return clock.NowUs() >= due_us; }, 10s);
    if (event.channel == kStereoRigChannel) {
      auto m = Decode<stereo_rig_t>(event);
      m.utime += shift_us;
      bus.Publish(event.channel, m);
    } else if (event.channel == "IIWA_STATUS") {
      auto m = Decode<iiwa_status_t>(event);
      m.utime += shift_us;
      bus.Publish(event.channel, m);
    } else if (event.channel == kStereoImagesChannel && num_pairs++ % 3 == 0) {
      auto m = Decode<images_t>(event);
      m.utime += shift_us;
      bus.Publish(event.channel, m);
    }
  }
  ASSERT_TRUE(handle_until([&] { return poses.size() >= 15; }, 10s)) << poses.size();
  poses.erase(poses.begin());  // it may have come before the first arm state was through
  EXPECT_THAT(Sources(poses), Each(int{head_pose_t::SOURCE_ARM}));
  ASSERT_TRUE(handle_until([&] { return status.processed >= 300; }, 5s)) << status.last_error;
  EXPECT_EQ(status.rejected, 0) << status.last_error;
}

TEST(ArmStateUsageTest, BadInputGetsOneLineAndExitCode2) {
  const TemporaryFolder folder;
  const auto refusal = [](std::vector<std::string> flags) {
    flags.insert(flags.begin(), Program("arm-state"));
    const ProcessResult result = RunProcess(flags);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal({"--source", "ur5"}), HasSubstr("source: ur5: must be one of iiwa panda"));
  EXPECT_THAT(refusal({"--set", "rig_file=/none.yaml"}),
              HasSubstr("/none.yaml: must be a file that exists"));
  EXPECT_THAT(refusal({"--source", "csv", "--set", "csv_file=/none.csv"}), HasSubstr("/none.csv"));
  EXPECT_THAT(RunWell({Program("arm-state"), "--print-config"}),
              AllOf(HasSubstr("source: simulator"), HasSubstr("max_gap_ms: 50")));
}

}  // namespace
}  // namespace visavis
