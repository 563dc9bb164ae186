// visavis-recogniser --replay as its users start it, on a log of painted pictures from a moving
// camera: the same bytes each time and on every SIMD target, what the new log holds, exit codes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "common/convert/image_message.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "common/eventlog/event_log.h"
#include "tests/support/child_process.h"
#include "tests/support/log_writing.h"
#include "tests/support/simd_targets.h"
#include "tests/support/stereo_scene.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kPeriodUs = 33'333;
constexpr int kPairs = 12;

images_t ToMessage(const StereoFrame& frame) {
  images_t message{};
  message.utime = frame.utime_us;
  message.n_images = 2;
  message.image_types = {images_t::LEFT, images_t::RIGHT};
  message.images.resize(2);
  SetImage(*frame.left, frame.utime_us, &message.images[0]);
  SetImage(*frame.right, frame.utime_us, &message.images[1]);
  return message;
}

RigidTransform CameraPose(int pair) {
  return MakeTransform(ExpRotation({0, 0.004 * pair, 0}), Eigen::Vector3d(0.006 * pair, 0, 0));
}

const RigidTransform kHead = TransformFromPhi(PhiOf(-20, 10, 1050, 3, -4, 2));

class RecogniserReplayTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    StereoScene scene(HeadModelConfig{}, SmallRig());
    EventLogWriter writer(Input(), EventLogWriter::Mode::kReplace);
    WriteMessage("STEREO_RIG", visavis::ToMessage({SmallRig(), std::nullopt, std::nullopt}, 0),
                 &writer);
    for (int i = 0; i < kPairs; ++i) {
      const std::int64_t utime_us = i * kPeriodUs;
      WriteMessage("CAMERA_POSE", visavis::ToMessage(CameraPose(i), utime_us), &writer);
      const RigidTransform X_CM = CameraPose(i).inverse() * kHead;
      WriteMessage("HEAD_POSE_TRUTH", TruthMessage(utime_us, i, &X_CM), &writer);
      WriteMessage("STEREO_IMAGES", ToMessage(scene.Paint(X_CM, utime_us)), &writer);
      // What an earlier recogniser said of it.
      WriteMessage("HEAD_POSE", TruthMessage(utime_us, i + 1000, nullptr), &writer);
    }
    writer.Close();
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::string Input() { return *folder_ / "in.lcm"; }
  static std::string Output() { return *folder_ / "out.lcm"; }

  // The flags of a replay that starts near the head.
  static std::vector<std::string> ReplayFlags(const std::vector<std::string>& more = {}) {
    std::vector<std::string> flags = {"--replay", Input(),
                                      "--record", Output(),
                                      "--set",    "start.phi_mm_deg=[-20, 10, 1050, 3, -4, 2]"};
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  }
  static ProcessResult Run(std::vector<std::string> flags) {
    flags.insert(flags.begin(), VISAVIS_RECOGNISER);
    return RunProcess(flags);
  }
  static std::vector<LogEvent> Events(const std::string& path) {
    EventLogReader reader(path);
    std::vector<LogEvent> events;
    LogEvent event;
    while (reader.Next(&event)) events.push_back(event);
    return events;
  }
  static std::vector<LogEvent> EventsOf(const std::string& channel) {
    std::vector<LogEvent> events = Events(Output());
    events.erase(std::remove_if(events.begin(), events.end(),
                                [&](const LogEvent& event) { return event.channel != channel; }),
                 events.end());
    return events;
  }
  // Replays, and returns the bytes of all HEAD_POSE in a row.
  static std::vector<std::uint8_t> PoseBytes(const std::vector<std::string>& more = {}) {
    const ProcessResult result = Run(ReplayFlags(more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto events = EventsOf("HEAD_POSE");
    EXPECT_EQ(events.size(), static_cast<std::size_t>(kPairs));
    std::vector<std::uint8_t> bytes;
    for (const LogEvent& event : events)
      bytes.insert(bytes.end(), event.data.begin(), event.data.end());
    return bytes;
  }
  // Flags that must be refused: the line on stderr.
  static std::string Refusal(const std::vector<std::string>& flags, int exit_code) {
    const ProcessResult result = Run(flags);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  }

  static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> RecogniserReplayTest::folder_;

TEST_F(RecogniserReplayTest, FollowsTheHead) {
  PoseBytes({"--set", "estimator=published"});  // a painted ellipsoid is no face to the other
  const auto events = EventsOf("HEAD_POSE");
  for (int i = 0; i < kPairs; ++i) {
    head_pose_t pose;
    ASSERT_GT(pose.decode(events[i].data.data(), 0, static_cast<int>(events[i].data.size())), 0);
    EXPECT_EQ(pose.utime, i * kPeriodUs);
    EXPECT_EQ(pose.seq, i);
    const auto error = ComputeRecognitionError(CameraPose(i).inverse() * kHead, FromMessage(pose));
    EXPECT_LT(error.position.norm(), 0.04);
    EXPECT_TRUE(pose.has_world_pose);
    EXPECT_EQ(pose.feedforward_source, head_pose_t::SOURCE_CAMERA_POSE);
  }
}

// Of both estimators.
const std::string kEstimators[] = {"estimator=published", "estimator=refined"};

TEST_F(RecogniserReplayTest, TwiceGivesTheSameBytesAndAnotherSeedOthers) {
  for (const std::string& estimator : kEstimators) {
    const auto bytes = PoseBytes({"--set", estimator});
    EXPECT_EQ(PoseBytes({"--set", estimator}), bytes) << estimator;
    // From far off, where chance has a say.
    const std::string far = "start.phi_mm_deg=[150, 100, 1150, 0, 0, 0]";
    EXPECT_NE(PoseBytes({"--set", estimator, "--set", far, "--set", "seed=2"}),
              PoseBytes({"--set", estimator, "--set", far}))
        << estimator;
  }
}

TEST_F(RecogniserReplayTest, EverySimdTargetGivesTheSameBytes) {
  for (const std::string& estimator : kEstimators) {
    const auto bytes = PoseBytes({"--set", estimator});
    for (const std::string& target : ListSimdTargets()) {
      EXPECT_EQ(PoseBytes({"--set", estimator, "--set", "simd=" + target}), bytes)
          << estimator << ", " << target;
    }
  }
}

TEST_F(RecogniserReplayTest, FeedforwardChangesThePoses) {
  for (const std::string& estimator : kEstimators) {
    const auto exact = PoseBytes({"--set", estimator, "--set", "feedforward=exact"});
    EXPECT_NE(PoseBytes({"--set", estimator, "--set", "feedforward=none"}), exact) << estimator;
    EXPECT_NE(PoseBytes({"--set", estimator, "--set", "feedforward=jacobian"}), exact) << estimator;
  }
}

// Channel and bytes of an event, for comparison.
std::vector<std::pair<std::string, std::vector<std::uint8_t>>> InputsOf(
    const std::vector<LogEvent>& events, bool with_images) {
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> inputs;
  for (const LogEvent& event : events) {
    if (event.channel == "STEREO_RIG" || event.channel == "CAMERA_POSE" ||
        event.channel == "HEAD_POSE_TRUTH" || (with_images && event.channel == "STEREO_IMAGES")) {
      inputs.emplace_back(event.channel, event.data);
    }
  }
  return inputs;
}

TEST_F(RecogniserReplayTest, TheNewLogHoldsTheInputsButImagesOnlyWhenAsked) {
  PoseBytes();
  EXPECT_EQ(InputsOf(Events(Output()), true), InputsOf(Events(Input()), false));
  PoseBytes({"--keep-images"});
  EXPECT_EQ(InputsOf(Events(Output()), true), InputsOf(Events(Input()), true));
}

TEST_F(RecogniserReplayTest, ALogThatWasReplayedReplaysToTheSameBytes) {
  const auto bytes = PoseBytes({"--keep-images"});
  const std::string again = *folder_ / "again.lcm";
  std::filesystem::rename(Output(), again);
  auto flags = ReplayFlags();
  flags[1] = again;
  ASSERT_EQ(Run(flags).exit_code, 0);
  std::vector<std::uint8_t> bytes_again;
  for (const LogEvent& event : EventsOf("HEAD_POSE"))
    bytes_again.insert(bytes_again.end(), event.data.begin(), event.data.end());
  EXPECT_EQ(bytes_again, bytes);
}

TEST_F(RecogniserReplayTest, RecordingOverTheInputIsRefusedAndTheInputStays) {
  const auto size = std::filesystem::file_size(Input());
  auto flags = ReplayFlags();
  flags[3] = Input();
  EXPECT_THAT(Refusal(flags, 2), HasSubstr("--record"));
  const std::string link = *folder_ / "link.lcm";
  std::filesystem::create_symlink(Input(), link);
  flags[3] = link;
  EXPECT_THAT(Refusal(flags, 2), HasSubstr("--record"));
  EXPECT_EQ(std::filesystem::file_size(Input()), size);
}

TEST_F(RecogniserReplayTest, AConfigurationThatIsRefusedLeavesAnEarlierLogAsItIs) {
  const std::string rig = *folder_ / "bad_rig.yaml", earlier = *folder_ / "earlier.lcm";
  std::ofstream(rig) << "right: {width: 0}\n";
  std::ofstream(earlier) << "an earlier log";
  auto flags = ReplayFlags({"--set", "rig_file=" + rig});
  flags[3] = earlier;
  EXPECT_THAT(Refusal(flags, 2), HasSubstr(rig));
  std::string text;
  std::getline(std::ifstream(earlier), text);
  EXPECT_EQ(text, "an earlier log");
  // And where there was none, none is left behind.
  flags[3] = *folder_ / "none.lcm";
  Refusal(flags, 2);
  EXPECT_FALSE(std::filesystem::exists(flags[3]));
}

TEST_F(RecogniserReplayTest, BadFlagsAndConfigurationsExitWith2AndOneLine) {
  const auto refusal = [](const std::vector<std::string>& more) {
    return Refusal(ReplayFlags(more), 2);
  };
  EXPECT_THAT(refusal({"--no-such-flag"}), HasSubstr("--no-such-flag"));
  EXPECT_THAT(refusal({"--set", "ga.individuals=1"}), HasSubstr("ga.individuals"));
  EXPECT_THAT(refusal({"--set", "ga.individual=60"}), HasSubstr("ga.individual"));
  EXPECT_THAT(refusal({"--set", "simd=MMX"}), HasSubstr("simd"));
  EXPECT_THAT(refusal({"--config", *folder_ / "nowhere.yaml"}), HasSubstr("nowhere.yaml"));
  const std::string file = *folder_ / "bad.yaml";
  std::ofstream(file) << "seed: 3\nsearch:\n  preset: custom\n  max_x_mm: -900\n";
  EXPECT_THAT(refusal({"--config", file}),
              ::testing::AllOf(HasSubstr("bad.yaml:4"), HasSubstr("search.max_x_mm"),
                               HasSubstr("-900"), HasSubstr("must exceed")));
  const std::string rig = *folder_ / "rig.yaml";
  std::ofstream(rig) << "right: {width: 640}\n";
  EXPECT_THAT(refusal({"--set", "rig_file=" + rig}), HasSubstr("rig.yaml"));
}

TEST_F(RecogniserReplayTest, ALogThatIsNotThereFailsWithOneLineThatNamesIt) {
  auto flags = ReplayFlags();
  flags[1] = *folder_ / "nowhere.lcm";
  const ProcessResult result = Run(flags);
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("nowhere.lcm"));
}

TEST_F(RecogniserReplayTest, HelpVersionAndACheckedConfigurationExitWith0) {
  EXPECT_EQ(Run({"--help"}).exit_code, 0);
  EXPECT_EQ(Run({"--version"}).exit_code, 0);
  EXPECT_EQ(Run({"--check-config", "--set", "estimator=published"}).exit_code, 0);
}

TEST_F(RecogniserReplayTest, RefusedMessagesAreToldAndDoNotStopTheReplay) {
  const std::string spoilt = *folder_ / "spoilt.lcm";
  EventLogWriter writer(spoilt, EventLogWriter::Mode::kReplace);
  for (const LogEvent& event : Events(Input())) {
    writer.Write(event.utime, event.channel, event.data.data(), event.data.size());
    if (event.channel == "STEREO_RIG") writer.Write(event.utime, "STEREO_IMAGES", "junk", 4);
  }
  writer.Close();
  auto flags = ReplayFlags();
  flags[1] = spoilt;
  const ProcessResult result = Run(flags);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("refused 1 message"));
  EXPECT_THAT(result.err, HasSubstr("STEREO_IMAGES"));
  EXPECT_EQ(EventsOf("HEAD_POSE").size(), static_cast<std::size_t>(kPairs));
}

}  // namespace
}  // namespace visavis
