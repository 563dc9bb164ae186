#include "common/recording/log_contents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/convert/pose_message.h"
#include "tests/support/log_writing.h"
#include "tests/support/run_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

TEST(LogContentsTest, ReadsEveryChannelInOrder) {
  const TemporaryFolder folder;
  RunLog log(folder / "a.lcm");
  log.CameraPose(1, Pose(0.1, 0, 0));
  log.Truth(2, Pose(0, 0, 1), Pose(0.1, 0, 0));
  log.Truth(3, std::nullopt);
  log.Estimate(4, RunLog::kTracking, Pose(0, 0, 1));
  log.Latency(5, 7);
  log.Close();
  const LogContents contents = ReadLog(folder / "a.lcm", "", nullptr);
  EXPECT_EQ(contents.num_events, 5);
  EXPECT_EQ(contents.num_rejected, 0);
  ASSERT_EQ(contents.camera_poses.size(), 1u);
  EXPECT_EQ(contents.camera_poses[0].X.translation().x(), 0.1);
  ASSERT_EQ(contents.truth.size(), 2u);
  EXPECT_EQ(contents.truth[0].X_CM->translation().z(), 1);
  EXPECT_EQ(contents.truth[0].X_WM->translation().x(), 0.1);
  EXPECT_FALSE(contents.truth[1].X_CM);
  ASSERT_EQ(contents.head_poses.size(), 1u);
  EXPECT_EQ(contents.head_poses[0].utime, 4);
  ASSERT_EQ(contents.timings.size(), 1u);
  EXPECT_EQ(contents.timings[0].latency_ms, 7);
  EXPECT_FALSE(contents.rig);
}

TEST(LogContentsTest, MessagesThatMakeNoSenseAreCountedAndNamed) {
  const TemporaryFolder folder;
  {
    EventLogWriter writer(folder / "a.lcm", EventLogWriter::Mode::kCreate);
    rigid_transform_t pose = ToMessage(Pose(0, 0, 0), 1);
    pose.quat[0] = 2;
    WriteMessage("CAMERA_POSE", pose, &writer);
    writer.Write(2, "HEAD_POSE", "short", 5);
  }
  const LogContents contents = ReadLog(folder / "a.lcm", "", nullptr);
  EXPECT_EQ(contents.num_rejected, 2);
  EXPECT_EQ(contents.last_reject, "HEAD_POSE: is no head_pose_t");
  EXPECT_TRUE(contents.camera_poses.empty());
}

TEST(LogContentsTest, OnlyThePrefixedChannelsAreRead) {
  const TemporaryFolder folder;
  {
    EventLogWriter writer(folder / "a.lcm", EventLogWriter::Mode::kCreate);
    WriteMessage("ROBOT1_CAMERA_POSE", ToMessage(Pose(1, 0, 0), 1), &writer);
    WriteMessage("CAMERA_POSE", ToMessage(Pose(2, 0, 0), 1), &writer);
  }
  const LogContents contents = ReadLog(folder / "a.lcm", "ROBOT1_", nullptr);
  ASSERT_EQ(contents.camera_poses.size(), 1u);
  EXPECT_EQ(contents.camera_poses[0].X.translation().x(), 1);
}

TEST(LogContentsTest, AFileThatIsNoLogIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.lcm") << "text";
  EXPECT_THAT([&] { ReadLog(folder / "a.lcm", "", nullptr); },
              ::testing::ThrowsMessage<std::invalid_argument>(
                  folder / "a.lcm" + ": must be an LCM event log, holds no event"));
}

}  // namespace
}  // namespace visavis
