#include "services/log_tool/log_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/eventlog/event_log_writer.h"
#include "services/log_tool/sequence_import.h"
#include "tests/support/sequence_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(LogInfoTest, CountsChannelsRatesBytesAndFramesWithTruth) {
  const SequenceFolder folder;
  const TemporaryFolder out;
  ImportSequence(folder.path(), out / "a.lcm", "");
  const LogInfo info = ReadLogInfo(out / "a.lcm", "");
  ASSERT_EQ(info.channels.size(), 4u);
  const ChannelInfo& images = info.channels.at("STEREO_IMAGES");
  EXPECT_EQ(images.num_events, 4);
  EXPECT_DOUBLE_EQ(images.rate_hz(), 10);
  EXPECT_THAT(images.types, ElementsAre("visavis.images_t"));
  EXPECT_THAT(info.channels.at("CAMERA_POSE").types, ElementsAre("visavis.rigid_transform_t"));
  EXPECT_EQ(info.channels.at("CAMERA_POSE").num_bytes, 4 * (8 + 8 + 7 * 8));
  EXPECT_EQ(info.channels.at("STEREO_RIG").rate_hz(), 0);
  EXPECT_EQ(info.num_events, 1 + 4 + 3 + 4);
  EXPECT_EQ(info.num_frames, 4);
  EXPECT_EQ(info.num_frames_with_truth, 3);
  EXPECT_EQ(info.last_us - info.first_us, 300'000);
  EXPECT_EQ(info.num_damaged_bytes, 0);
  EXPECT_THAT(FormatLogInfo("a.lcm", info), HasSubstr("frames: 4, with truth: 3"));
}

TEST(LogInfoTest, ForeignShortAndDamagedEventsAreShown) {
  const TemporaryFolder out;
  {
    EventLogWriter writer(out / "a.lcm", EventLogWriter::Mode::kCreate);
    const std::uint8_t iiwa[16] = {0xf1, 0x6f, 0xb8, 0x04, 0x28, 0x4a, 0xbc, 0xa3};
    const std::uint8_t other[16] = {1, 2, 3, 4, 5, 6, 7, 8};
    writer.Write(5'000'000, "IIWA_STATUS", iiwa, 16);
    writer.Write(3'000'000, "OTHER", other, 16);
    writer.Write(3'000'000, "OTHER", other, 3);
  }
  std::ofstream(out / "a.lcm", std::ios::app) << "garbage";
  const LogInfo info = ReadLogInfo(out / "a.lcm", "");
  EXPECT_THAT(info.channels.at("IIWA_STATUS").types, ElementsAre("drake.lcmt_iiwa_status"));
  EXPECT_THAT(info.channels.at("OTHER").types, ElementsAre("none", "unknown 0102030405060708"));
  EXPECT_EQ(info.num_backward_jumps, 1);
  EXPECT_EQ(info.num_damaged_bytes, 7);
  EXPECT_EQ(info.num_truncated_bytes, 0);
  EXPECT_THAT(FormatLogInfo("a.lcm", info), HasSubstr("DAMAGED: 7 bytes in 1 places\n"));
}

TEST(LogInfoTest, ATruncatedLogSaysSo) {
  const SequenceFolder folder;
  const TemporaryFolder out;
  ImportSequence(folder.path(), out / "a.lcm", "");
  std::filesystem::resize_file(out / "a.lcm", std::filesystem::file_size(out / "a.lcm") - 10);
  const LogInfo info = ReadLogInfo(out / "a.lcm", "");
  EXPECT_EQ(info.channels.at("STEREO_IMAGES").num_events, 3);
  EXPECT_GT(info.num_truncated_bytes, 0);
  EXPECT_THAT(FormatLogInfo("a.lcm", info), HasSubstr("an unfinished event at the end"));
}

TEST(LogInfoTest, ALogMayBeEmptyButOtherFilesAreNoLogs) {
  const TemporaryFolder out;
  std::ofstream(out / "empty.lcm").flush();
  EXPECT_EQ(ReadLogInfo(out / "empty.lcm", "").num_events, 0);
  std::ofstream(out / "text.lcm") << "no log";
  EXPECT_THROW(ReadLogInfo(out / "text.lcm", ""), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
