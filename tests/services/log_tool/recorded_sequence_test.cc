#include "services/log_tool/recorded_sequence.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "services/log_tool/sequence_import.h"
#include "tests/support/sequence_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;

/// One way to spoil a folder, and how the complaint goes on behind the folder's name.
struct BadFolder {
  const char* name;
  std::function<void(const SequenceFolder&)> spoil;
  const char* complaint;
};

using F = const SequenceFolder&;

void AddArm(F f, const char* csv) {
  f.Write("arm.urdf", R"(<robot name="a"><link name="base"/><link name="tip"/>
<joint name="j1" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>
</joint></robot>)");
  f.Write("rig.yaml", f.Read("rig.yaml") + "arm: {urdf: arm.urdf, base: base, tip: tip}\n");
  f.Write("arm.csv", csv);
}

const BadFolder kBadFolders[] = {
    {"MissingRig", [](F f) { f.Write("rig.yaml", ""); }, "/rig.yaml: cannot be read"},
    {"UnknownRigKey", [](F f) { f.Replace("rig.yaml", "fx", "fz"); },
     "/rig.yaml:1: right.fz: 10: unknown key"},
    {"MillimetreBaseline", [](F f) { f.Replace("rig.yaml", "-0.15", "-150"); },
     "/rig.yaml:3: X_CL"},
    {"RigQuaternion", [](F f) { f.Replace("rig.yaml", "[1, 0, 0, 0]", "[1, 1, 0, 0]"); },
     "/rig.yaml:3: X_CL.q_wxyz: norm 1.414214: must be 1 within 0.001"},
    {"MissingFrames", [](F f) { f.Write("frames.csv", ""); },
     "/frames.csv: cannot be read, or is empty"},
    {"NoFrames", [](F f) { f.Write("frames.csv", "frame,time_s,left,right\n"); },
     "/frames.csv:2: must have a row a frame"},
    {"MissingColumn", [](F f) { f.Replace("frames.csv", "left", "links"); },
     "/frames.csv:1: frame,time_s,links,right: must have a column 'left'"},
    {"MissingPicture", [](F f) { f.Write("b_left.pgm", ""); },
     "/frames.csv:4: left: b_left.pgm: must be a picture file in the folder"},
    {"NoPictureNamed", [](F f) { f.Replace("frames.csv", ",a_right.ppm\n", ",\n"); },
     "/frames.csv:2: right: empty: must be a picture file in the folder"},
    {"WrongPictureSize", [](F f) { f.Write("b_left.pgm", MakePnm(9, 6, true, 1)); },
     "/frames.csv:4: left: b_left.pgm: must be 8x6 px as in rig.yaml, is 9x6"},
    {"WrongJpegSize", [](F f) { f.Write("b_right.jpg", MakeJpeg(8, 8)); },
     "/frames.csv:4: right: b_right.jpg: must be 8x6 px as in rig.yaml, is 8x8"},
    {"CutJpeg",
     [](F f) {
       const std::string jpeg = f.Read("b_right.jpg");
       f.Write("b_right.jpg", jpeg.substr(0, jpeg.size() - 20));
     },
     "/frames.csv:4: right: b_right.jpg: must be an undamaged picture"},
    {"NoPicture", [](F f) { f.Write("a_right.ppm", "text"); },
     "/frames.csv:2: right: a_right.ppm: must be an undamaged picture, is none"},
    {"DecreasingTime", [](F f) { f.Replace("frames.csv", "2,0.200000", "2,0.05"); },
     "/frames.csv:4: time_s: 0.05: must be later than the row before, by 1e-6 s at least"},
    {"EqualTime", [](F f) { f.Replace("frames.csv", "0.200000", "0.1000001"); },
     "/frames.csv:4: time_s: 0.1000001: must be later than the row before"},
    {"NegativeTime", [](F f) { f.Replace("frames.csv", "0,0.000000", "0,-0.5"); },
     "/frames.csv:2: time_s: -0.5: must be 0 to 9e12 s"},
    {"InfiniteTime", [](F f) { f.Replace("frames.csv", "0.300000", "inf"); },
     "/frames.csv:5: time_s: inf: must be a finite number"},
    {"FrameTwice", [](F f) { f.Replace("frames.csv", "2,0.2", "1,0.2"); },
     "/frames.csv:4: frame: 1: must name a frame once"},
    {"FrameNoNumber", [](F f) { f.Replace("frames.csv", "2,0.2", "two,0.2"); },
     "/frames.csv:4: frame: two: must be a whole number >= 0"},
    {"TruthOfUnknownFrame", [](F f) { f.Replace("truth.csv", "2,0.2", "3,0.2"); },
     "/truth.csv:4: frame: 3: must be a frame of frames.csv"},
    {"TruthAtAnotherTime", [](F f) { f.Replace("truth.csv", "2,0.200000", "2,0.202"); },
     "/truth.csv:4: time_s: 0.202: must be the time of frame 2 in frames.csv, within 0.001 s"},
    {"TruthNotFinite", [](F f) { f.Replace("truth.csv", "-0.13", "nan"); },
     "/truth.csv:4: x_m: nan: must be a finite number"},
    {"TruthNotUnit", [](F f) { f.Replace("truth.csv", "1,0.8,", "1,0.9,"); },
     "/truth.csv:2: qw: 0.9: qw, qx, qy, qz have norm 1.081665, must be 1 within 0.001"},
    {"TruthColumnMissing", [](F f) { f.Replace("truth.csv", ",qz", ",q"); },
     "/truth.csv:1: frame,time_s,x_m,y_m,z_m,qw,qx,qy,q: must have a column 'qz'"},
    {"TruthFrameTwice", [](F f) { f.Replace("truth.csv", "2,0.200000", "1,0.100000"); },
     "/truth.csv:4: time_s: 0.100000: must be later than the row before"},
    {"CameraPoseShortRow", [](F f) { f.Replace("camera_pose.csv", ",0,0,1,0,0,0\n", ",0\n"); },
     "/camera_pose.csv:2: row of 4 cells: must have 9 as the header"},
    {"CameraPoseFarAway", [](F f) { f.Replace("camera_pose.csv", "0.14", "1.4e7"); },
     "/camera_pose.csv:3: x_m: 1.4e7: must be within 1e6 m"},
    {"UnknownJoint", [](F f) { AddArm(f, "time_s,j9\n0,1\n"); },
     "/arm.csv:1: time_s,j9: must have a column 'j1'"},
    {"JointNotFinite", [](F f) { AddArm(f, "time_s,j1\n0,1\n0.1,-inf\n"); },
     "/arm.csv:3: j1: -inf: must be a finite number"},
    {"ArmTimeDecreases", [](F f) { AddArm(f, "time_s,j1\n0.2,1\n0.1,1\n"); },
     "/arm.csv:3: time_s: 0.1: must be later than the row before"},
    {"ArmWithoutJoints", [](F f) { f.Write("arm.csv", "time_s\n0.2\n"); },
     "/arm.csv:1: 0 joints: must be 1 to 64"},
    {"MissingUrdf",
     [](F f) {
       AddArm(f, "time_s,j1\n0,1\n");
       f.Write("arm.urdf", "");
     },
     "/rig.yaml:4: arm.urdf"},
    {"NoUrdf",
     [](F f) {
       AddArm(f, "time_s,j1\n0,1\n");
       f.Write("arm.urdf", "no robot");
     },
     "/rig.yaml: arm: "},
};

class BadFolderTest : public ::testing::TestWithParam<BadFolder> {};

TEST_P(BadFolderTest, IsRefusedInOneLineWithPlaceValueAndRule) {
  const SequenceFolder folder;
  const TemporaryFolder out;
  GetParam().spoil(folder);
  try {
    ImportSequence(folder.path(), out / "out.lcm", "");
    FAIL() << "was accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), ::testing::StartsWith(folder.path() + GetParam().complaint));
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
  }
  EXPECT_TRUE(std::filesystem::is_empty(out.path()));
}

INSTANTIATE_TEST_SUITE_P(All, BadFolderTest, ::testing::ValuesIn(kBadFolders),
                         [](const auto& bad) { return bad.param.name; });

TEST(RecordedSequenceTest, WithoutAnArmDescriptionEveryColumnIsAJoint) {
  const SequenceFolder folder;
  folder.Write("arm.csv", "frame,time_s,a,b\n0,0.0,1,2\n1,0.1,3,4\n");
  const RecordedSequence sequence = ReadRecordedSequence(folder.path());
  EXPECT_THAT(sequence.joint_names, ElementsAre("a", "b"));
  EXPECT_THAT(sequence.arm_states.at(1).positions, ElementsAre(3, 4));
}

TEST(RecordedSequenceTest, FurtherColumnsOfADescribedArmAreNoJoints) {
  const SequenceFolder folder;
  AddArm(folder, "time_s,gripper,j1\n0,,1\n");
  const RecordedSequence sequence = ReadRecordedSequence(folder.path());
  EXPECT_THAT(sequence.joint_names, ElementsAre("j1"));
  EXPECT_THAT(sequence.arm_states.at(0).velocities, ElementsAre(0));
}

TEST(RecordedSequenceTest, PosesAndTruthAreOptional) {
  const SequenceFolder folder;
  folder.Write("camera_pose.csv", "");
  folder.Write("truth.csv", "");
  const RecordedSequence sequence = ReadRecordedSequence(folder.path());
  EXPECT_EQ(sequence.frames.size(), 4u);
  EXPECT_TRUE(sequence.camera_poses.empty());
  EXPECT_TRUE(sequence.truth.empty());
  EXPECT_TRUE(sequence.arm_states.empty());
}

}  // namespace
}  // namespace visavis
