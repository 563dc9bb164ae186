#include "services/log_tool/sequence_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/sequence_folder.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"
#include "visavis/rigid_transform_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {
namespace {

using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr char kArmUrdf[] = R"(<robot name="arm"><link name="base"/><link name="mid"/>
<link name="tip"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="mid"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="j2" type="prismatic"><parent link="mid"/><child link="tip"/><axis xyz="1 0 0"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>)";

class SequenceImportTest : public ::testing::Test {
 protected:
  std::string log() const { return out_ / "out.lcm"; }
  ImportSummary Import() const { return ImportSequence(folder_.path(), log(), ""); }
  std::vector<std::string> Channels() const {
    std::vector<std::string> channels;
    for (const auto& event : ReadEvents(log())) {
      channels.push_back(event.channel + " " + std::to_string(event.utime));
    }
    return channels;
  }

  const SequenceFolder folder_;
  const TemporaryFolder out_;
};

TEST_F(SequenceImportTest, EventsComeByTimeAndBeforeTheImagesOfTheirTime) {
  folder_.Replace("frames.csv", "5,0.300000", "5,1.000000");
  folder_.Replace("camera_pose.csv", "5,0.300000", "5,1.000000");
  Import();
  EXPECT_THAT(Channels(),
              ElementsAre("STEREO_RIG 0", "CAMERA_POSE 0", "HEAD_POSE_TRUTH 0", "STEREO_IMAGES 0",
                          "CAMERA_POSE 100000", "HEAD_POSE_TRUTH 100000", "STEREO_IMAGES 100000",
                          "CAMERA_POSE 200000", "HEAD_POSE_TRUTH 200000", "STEREO_IMAGES 200000",
                          "STEREO_RIG 1000000", "CAMERA_POSE 1000000", "STEREO_IMAGES 1000000"));
}

TEST_F(SequenceImportTest, TimesAreRoundedToTheMicrosecond) {
  folder_.Write("camera_pose.csv", "");
  folder_.Write("truth.csv", "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n2,0.0666,0,0,1,1,0,0,0\n");
  folder_.Write("frames.csv",
                "frame,time_s,left,right\n"
                "1,0.0333333333,a_left.ppm,a_right.ppm\n"
                "2,0.0666666667,a_left.ppm,a_right.ppm\n"
                "3,1700000000.1234565,a_left.ppm,a_right.ppm\n");
  Import();
  const auto images = ReadMessages<images_t>(log(), "STEREO_IMAGES");
  ASSERT_THAT(images, SizeIs(3));
  EXPECT_EQ(images[0].utime, 33333);
  EXPECT_EQ(images[1].utime, 66667);
  EXPECT_NEAR(static_cast<double>(images[2].utime), 1700000000123456.0, 1);
  EXPECT_EQ(images[1].images[1].utime, 66667);
  // Truth carries the frame's time, whatever digits its own row has.
  EXPECT_EQ(ReadMessages<head_pose_t>(log(), "HEAD_POSE_TRUTH").at(0).utime, 66667);
}

TEST_F(SequenceImportTest, PicturesKeepTheirKind) {
  Import();
  const auto pairs = ReadMessages<images_t>(log(), "STEREO_IMAGES");
  ASSERT_THAT(pairs, SizeIs(4));
  EXPECT_THAT(pairs[0].image_types, ElementsAre(images_t::LEFT, images_t::RIGHT));
  const image_t& rgb = pairs[0].images[0];
  EXPECT_EQ(rgb.pixelformat, image_t::PIXELFORMAT_RGB);
  EXPECT_EQ(rgb.width, 8);
  EXPECT_EQ(rgb.height, 6);
  EXPECT_EQ(rgb.row_stride, 24);
  EXPECT_EQ(rgb.data, MakePixels(8, 6, false, 1));
  EXPECT_EQ(pairs[1].images[0].data, rgb.data);  // the same picture in two frames
  const image_t& grey = pairs[2].images[0];
  EXPECT_EQ(grey.pixelformat, image_t::PIXELFORMAT_GRAY);
  EXPECT_EQ(grey.data, MakePixels(8, 6, true, 3));
  const image_t& jpeg = pairs[3].images[1];
  EXPECT_EQ(jpeg.pixelformat, image_t::PIXELFORMAT_MJPEG);
  EXPECT_EQ(jpeg.row_stride, 0);
  EXPECT_EQ(std::string(jpeg.data.begin(), jpeg.data.end()), folder_.Read("b_right.jpg"));
  // The frame's own number travels in the metadata.
  ASSERT_EQ(jpeg.nmetadata, 1);
  EXPECT_EQ(jpeg.metadata[0].key, "seq");
  EXPECT_THAT(jpeg.metadata[0].value, ElementsAre('5'));
}

TEST_F(SequenceImportTest, TruthIsTheHeadsPoseInCameraAndWorld) {
  folder_.Replace("truth.csv", "0,0.000000,-0.15,0.01,1,0.8,0.6,0,0",
                  "0,0.000000,-0.15,0.01,1,-0.8,-0.6,0,0");  // the same rotation
  Import();
  const auto truth = ReadMessages<head_pose_t>(log(), "HEAD_POSE_TRUTH");
  ASSERT_THAT(truth, SizeIs(3));
  const double x_m[] = {-0.15, -0.14, -0.13};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(truth[i].utime, 100'000 * static_cast<int>(i));
    EXPECT_EQ(truth[i].seq, static_cast<int>(i));
    EXPECT_EQ(truth[i].status, head_pose_t::STATUS_TRACKING);
    EXPECT_THAT(truth[i].p_CM_m, ElementsAre(x_m[i], 0.01, 1));
    EXPECT_THAT(truth[i].q_CM_wxyz, ElementsAre(DoubleEq(0.8), DoubleEq(0.6), 0, 0));
    EXPECT_NEAR(truth[i].euler_zyx_CM_rad[2], 2 * std::atan2(0.6, 0.8), 1e-12);
    // At rest in the world while the camera moves.
    EXPECT_TRUE(truth[i].has_world_pose);
    EXPECT_THAT(truth[i].p_WM_m, ElementsAre(DoubleNear(0, 1e-15), DoubleEq(0.01), DoubleEq(1)));
  }
}

TEST_F(SequenceImportTest, RigAndCameraPosesArriveAsMessages) {
  Import();
  const auto rigs = ReadMessages<stereo_rig_t>(log(), "STEREO_RIG");
  ASSERT_THAT(rigs, SizeIs(1));
  EXPECT_EQ(rigs[0].right.width, 8);
  EXPECT_EQ(rigs[0].left.distortion[0], 0.1);
  EXPECT_THAT(rigs[0].p_CL_m, ElementsAre(-0.15, 0, 0));
  EXPECT_FALSE(rigs[0].has_hand_eye);
  const auto poses = ReadMessages<rigid_transform_t>(log(), "CAMERA_POSE");
  ASSERT_THAT(poses, SizeIs(4));
  EXPECT_EQ(poses[3].utime, 300'000);
  EXPECT_THAT(poses[3].trans, ElementsAre(0.12, 0, 0));
  EXPECT_THAT(poses[3].quat, ElementsAre(1, 0, 0, 0));
}

TEST_F(SequenceImportTest, ArmStatesComeInChainOrderWithDifferencesAsVelocities) {
  folder_.Write("arm.urdf", kArmUrdf);
  folder_.Write("rig.yaml", folder_.Read("rig.yaml") +
                                "X_HC: {p_m: [0, 0, 0.1], q_wxyz: [1, 0, 0, 0]}\n"
                                "arm: {urdf: arm.urdf, base: base, tip: tip}\n");
  folder_.Write("arm.csv", "j2,time_s,j1\n1.0,0.0,0.0\n1.1,0.1,0.3\n1.4,0.3,0.1\n");
  Import();
  const auto states = ReadMessages<arm_state_t>(log(), "ARM_STATE");
  ASSERT_THAT(states, SizeIs(3));
  EXPECT_THAT(states[1].joint_names, ElementsAre("j1", "j2"));
  EXPECT_THAT(states[1].joint_position, ElementsAre(0.3, 1.1));
  const auto near = [](double v) { return DoubleNear(v, 1e-12); };
  EXPECT_THAT(states[0].joint_velocity, ElementsAre(near(3), near(1)));
  EXPECT_THAT(states[1].joint_velocity, ElementsAre(near(0.1 / 0.3), near(0.4 / 0.3)));
  EXPECT_THAT(states[2].joint_velocity, ElementsAre(near(-1), near(1.5)));
  EXPECT_EQ(states[2].utime, 300'000);
  EXPECT_EQ(states[2].seq, 2);
  const auto rig = ReadMessages<stereo_rig_t>(log(), "STEREO_RIG").at(0);
  EXPECT_EQ(rig.arm_urdf, kArmUrdf);
  EXPECT_EQ(rig.p_HC_m[2], 0.1);
}

TEST_F(SequenceImportTest, SpreadsheetFormsAndFurtherColumnsAndFilesAreAccepted) {
  Import();
  const auto before = ReadEvents(log());
  folder_.Write("notes.txt", "anything");
  folder_.Write("a_mask.png", "no picture");
  for (const char* name : {"camera_pose.csv", "truth.csv", "rig.yaml"}) {
    std::string crlf;
    for (const char c : folder_.Read(name)) crlf += c == '\n' ? "\r\n" : std::string(1, c);
    folder_.Write(name, crlf);
  }
  folder_.Write("frames.csv",
                "right,note,time_s,frame,left\r\n"
                "a_right.ppm,x,0,0,a_left.ppm\r\n"
                "a_right.ppm,,0.1,1,a_left.ppm\r\n"
                "b_right.jpg,y z,2e-1,2,b_left.pgm\r\n"
                "\"b_right.jpg\",,0.3,5,\"b_left.pgm\"\r\n");
  Import();
  const auto after = ReadEvents(log());
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after[i].channel, before[i].channel);
    EXPECT_EQ(after[i].data, before[i].data) << after[i].channel;
  }
}

TEST_F(SequenceImportTest, APrefixGoesBeforeEveryChannel) {
  ImportSequence(folder_.path(), log(), "ROBOT1_");
  EXPECT_THAT(ReadMessages<images_t>(log(), "ROBOT1_STEREO_IMAGES"), SizeIs(4));
  EXPECT_THAT(ReadMessages<stereo_rig_t>(log(), "STEREO_RIG"), SizeIs(0));
}

TEST_F(SequenceImportTest, ABadPictureLeavesTheEarlierLogAndNothingElse) {
  Import();
  const auto before = std::filesystem::file_size(log());
  folder_.Write("b_right.jpg", "no jpeg");
  EXPECT_THROW(Import(), std::invalid_argument);
  EXPECT_EQ(std::filesystem::file_size(log()), before);
  for (const auto& entry : std::filesystem::directory_iterator(out_.path())) {
    EXPECT_EQ(entry.path().filename(), "out.lcm");
  }
}

TEST_F(SequenceImportTest, ALogThatCannotBeWrittenIsARunTimeFailure) {
  EXPECT_THROW(ImportSequence(folder_.path(), out_ / "none/out.lcm", ""), std::runtime_error);
}

}  // namespace
}  // namespace visavis
