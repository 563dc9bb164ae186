#include "services/log_tool/sequence_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/convert/image_message.h"
#include "common/convert/pose_message.h"
#include "common/csv/csv_table.h"
#include "services/log_tool/sequence_import.h"
#include "tests/support/log_writing.h"
#include "tests/support/sequence_folder.h"
#include "visavis/images_t.hpp"

namespace visavis {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

head_pose_t Estimate(std::int64_t utime) {
  head_pose_t message = EmptyHeadPose();
  message.utime = utime;
  SetPose(MakeTransform(ExpRotation({0, 0, 0.5}), Eigen::Vector3d(0.1, 1.0 / 3, 1)), &message);
  message.status = head_pose_t::STATUS_TRACKING;
  message.covariance[7] = 4e-6;
  message.fitness = 0.75;
  message.feedforward = head_pose_t::FEEDFORWARD_EXACT;
  message.feedforward_source = head_pose_t::SOURCE_CAMERA_POSE;
  return message;
}

class SequenceExportTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return out_ / name; }

  const SequenceFolder folder_;
  const TemporaryFolder out_;
};

TEST_F(SequenceExportTest, ExportedAndImportedAgainTheLogIsTheSame) {
  folder_.Write("arm.csv", "time_s,a,b\n0.0,1,2\n0.1,0.3333333333333333,4\n");
  ImportSequence(folder_.path(), File("a.lcm"), "");
  const ExportSummary summary = ExportSequence(File("a.lcm"), File("folder/"), "");
  EXPECT_EQ(summary.num_frames, 4);
  EXPECT_EQ(summary.num_pictures, 4);  // of 8: repeated ones are written once
  EXPECT_EQ(summary.num_truth, 3);
  EXPECT_EQ(summary.num_camera_poses, 4);
  EXPECT_EQ(summary.num_arm_states, 2);
  EXPECT_THAT(summary.notes, IsEmpty());
  ImportSequence(File("folder"), File("b.lcm"), "");
  const auto a = ReadEvents(File("a.lcm")), b = ReadEvents(File("b.lcm"));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].channel, b[i].channel);
    EXPECT_EQ(a[i].utime, b[i].utime);
    EXPECT_EQ(a[i].data, b[i].data) << a[i].channel;
  }
}

TEST_F(SequenceExportTest, JpegFilesComeBackByteByByte) {
  ImportSequence(folder_.path(), File("a.lcm"), "");
  ExportSequence(File("a.lcm"), File("folder"), "");
  std::ifstream file(File("folder/0001_right.jpg"), std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), folder_.Read("b_right.jpg"));
}

TEST_F(SequenceExportTest, HeadPosesBecomeATable) {
  ImportSequence(folder_.path(), File("a.lcm"), "");
  {
    EventLogWriter writer(File("a.lcm"), EventLogWriter::Mode::kAppend);
    WriteMessage("HEAD_POSE", Estimate(300'000), &writer);
    WriteMessage("HEAD_POSE", TruthMessage(300'001, 8, nullptr), &writer);
  }
  EXPECT_EQ(ExportSequence(File("a.lcm"), File("folder"), "").num_head_poses, 2);
  const CsvTable table(File("folder/head_pose.csv"));
  const auto text = [&](int row, const char* name) {
    return std::string(table.Text(row, table.Column(name)));
  };
  const auto number = [&](const char* name) { return table.Number(0, table.Column(name)); };
  ASSERT_EQ(table.num_rows(), 2);
  EXPECT_EQ(text(0, "frame"), "5");
  EXPECT_EQ(text(0, "time_s"), "0.300000");
  EXPECT_EQ(text(0, "status"), "TRACKING");
  EXPECT_EQ(number("y_m"), 1.0 / 3);
  EXPECT_NEAR(number("Phi_deg"), 0.5 * 180 / M_PI, 1e-12);
  EXPECT_NEAR(number("qz"), std::sin(0.25), 1e-15);
  EXPECT_DOUBLE_EQ(number("sigma_y_m"), 0.002);
  EXPECT_EQ(text(0, "sigma_x_m"), "");
  EXPECT_EQ(number("fitness"), 0.75);
  EXPECT_EQ(text(0, "feedforward"), "exact");
  EXPECT_EQ(text(0, "feedforward_source"), "camera_pose");
  EXPECT_EQ(text(0, "xw_m"), "");
  EXPECT_EQ(text(1, "frame"), "");  // no frame at this time
  EXPECT_EQ(text(1, "status"), "LOST");
  EXPECT_EQ(text(1, "x_m"), "");
}

TEST_F(SequenceExportTest, ALogWithoutImagesGivesItsTables) {
  {
    EventLogWriter writer(File("a.lcm"), EventLogWriter::Mode::kCreate);
    WriteMessage("HEAD_POSE_TRUTH", Estimate(100), &writer);
    WriteMessage("HEAD_POSE", Estimate(100), &writer);
    WriteMessage("HEAD_POSE", Estimate(200), &writer);
  }
  const ExportSummary summary = ExportSequence(File("a.lcm"), File("folder"), "");
  EXPECT_EQ(summary.num_head_poses, 2);
  EXPECT_EQ(summary.num_truth, 1);
  EXPECT_THAT(summary.notes,
              ElementsAre("no stereo pairs: no frames.csv", "no STEREO_RIG: no rig.yaml"));
  EXPECT_FALSE(std::filesystem::exists(File("folder/frames.csv")));
  EXPECT_EQ(CsvTable(File("folder/truth.csv")).Text(0, 1), "0.000100");
}

TEST_F(SequenceExportTest, BayerPicturesAreExportedAsColourAndBadPairsAreTold) {
  {
    const auto pixels = MakePixels(8, 6, true, 1);
    images_t pair{};
    pair.utime = 5;
    pair.n_images = 2;
    pair.image_types = {images_t::LEFT, images_t::RIGHT};
    pair.images.resize(2);
    for (auto& image : pair.images) {
      SetImage({pixels.data(), 8, 6, 8, pixels.size(), PixelFormat::kBayerRggb}, 5, &image);
    }
    EventLogWriter writer(File("a.lcm"), EventLogWriter::Mode::kCreate);
    WriteMessage("STEREO_IMAGES", pair, &writer);
    pair.utime = 6;
    pair.images[1].width = 9;  // longer than its row's stride
    WriteMessage("STEREO_IMAGES", pair, &writer);
  }
  const ExportSummary summary = ExportSequence(File("a.lcm"), File("folder"), "");
  EXPECT_EQ(summary.num_frames, 1);
  EXPECT_THAT(
      summary.notes,
      Contains(HasSubstr("left out 1 messages, the last: STEREO_IMAGES: image_t.row_stride: "
                         "8: must be at least width times bytes a pixel")));
  folder_.Write("frames.csv", "frame,time_s,left,right\n0,0,l.png,r.png\n");
  folder_.Write("camera_pose.csv", "");
  folder_.Write("truth.csv", "");
  std::filesystem::copy_file(File("folder/0000_left.png"), folder_.File("l.png"));
  std::filesystem::copy_file(File("folder/0000_right.png"), folder_.File("r.png"));
  ImportSequence(folder_.path(), File("b.lcm"), "");
  const auto pair = ReadMessages<images_t>(File("b.lcm"), "STEREO_IMAGES").at(0);
  EXPECT_EQ(pair.images[0].pixelformat, image_t::PIXELFORMAT_RGB);
}

TEST_F(SequenceExportTest, WhatIsInTheWayOrEmptyIsRefusedAndNothingIsLeft) {
  ImportSequence(folder_.path(), File("a.lcm"), "");
  EXPECT_THAT([&] { ExportSequence(File("a.lcm"), folder_.path(), ""); },
              ThrowsMessage<std::invalid_argument>(folder_.path() +
                                                   ": must not exist, or be an empty folder"));
  EXPECT_THAT([&] { ExportSequence(File("a.lcm"), File("none"), "ROBOT2_"); },
              ThrowsMessage<std::invalid_argument>(
                  File("a.lcm") + ": must hold a channel that can be exported (prefix ROBOT2_)"));
  std::ofstream(File("text.lcm")) << "no log at all";
  EXPECT_THAT([&] { ExportSequence(File("text.lcm"), File("none"), ""); },
              ThrowsMessage<std::invalid_argument>(File("text.lcm") +
                                                   ": must be an LCM event log, holds no event"));
  EXPECT_FALSE(std::filesystem::exists(File("none")));
  EXPECT_FALSE(std::filesystem::exists(File("none.part")));
}

}  // namespace
}  // namespace visavis
