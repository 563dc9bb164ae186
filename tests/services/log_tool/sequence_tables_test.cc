#include "services/log_tool/sequence_tables.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/run_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

class SequenceTablesTest : public ::testing::Test {
 protected:
  std::string path() const { return folder_ / "t.csv"; }
  std::string Text() const {
    std::ifstream file(path());
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const TemporaryFolder folder_;
  const std::vector<ExportedFrame> frames_{{0, 0, "a", "b"}, {7, 50'000, "c", "d"}};
};

TEST_F(SequenceTablesTest, TimesHaveSixDecimalsAndNumbersAreAsShortAsTheyMayBe) {
  EXPECT_EQ(WriteFramesCsv({{3, 1'700'000'000'000'001, "l.png", "r.png"}}, path()), 1);
  EXPECT_EQ(Text(), "frame,time_s,left,right\n3,1700000000.000001,l.png,r.png\n");
  EXPECT_EQ(WriteCameraPoseCsv({{0, 0, "", ""}}, {{0, Pose(0.1, 1.0 / 3, 0)}}, path()), 1);
  EXPECT_EQ(Text(),
            "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n"
            "0,0.000000,0.1,0.3333333333333333,0,1,0,0,0\n");
}

TEST_F(SequenceTablesTest, CameraPosesOfAnotherClockAreInterpolatedOverShortGaps) {
  const std::vector<StampedPose> poses{{-1'000, Pose(0, 0, 0)}, {99'000, Pose(0.1, 0, 0)}};
  EXPECT_EQ(WriteCameraPoseCsv(frames_, poses, path()), 2);
  EXPECT_NE(Text().find("7,0.050000,0.051"), std::string::npos) << Text();
  EXPECT_EQ(WriteCameraPoseCsv(frames_, {{-1, Pose(0, 0, 0)}, {100'000, Pose(1, 0, 0)}}, path()),
            0);
}

TEST_F(SequenceTablesTest, TruthOfAHeadThatIsAwayHasNoRow) {
  EXPECT_EQ(WriteTruthCsv(frames_, {{0, {}, {}}, {50'000, Pose(0, 0, 1), {}}}, path()), 1);
  EXPECT_EQ(Text(), "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz\n7,0.050000,0,0,1,1,0,0,0\n");
}

TEST_F(SequenceTablesTest, ArmStatesThatCannotBeImportedAreLeftOut) {
  const auto state = [](std::int64_t utime, std::vector<std::string> names,
                        std::vector<double> positions) {
    arm_state_t message{};
    message.utime = utime;
    message.joint_names = std::move(names);
    message.joint_position = std::move(positions);
    return message;
  };
  EXPECT_EQ(WriteArmCsv({state(0, {"a", "b"}, {1, 2}), state(0, {"a", "b"}, {3, 4}),
                         state(10, {"a", "c"}, {5, 6}), state(20, {"a", "b"}, {std::nan(""), 8}),
                         state(30, {"a", "b"}, {9, 0.5})},
                        path()),
            2);
  EXPECT_EQ(Text(), "time_s,a,b\n0.000000,1,2\n0.000030,9,0.5\n");
}

TEST_F(SequenceTablesTest, WithoutRowsThereIsNoFile) {
  EXPECT_EQ(WriteTruthCsv(frames_, {}, path()), 0);
  EXPECT_EQ(WriteArmCsv({}, path()), 0);
  EXPECT_EQ(WriteHeadPoseCsv(frames_, {}, path()), 0);
  EXPECT_FALSE(std::filesystem::exists(path()));
}

TEST_F(SequenceTablesTest, AFileThatCannotBeWrittenIsNamed) {
  try {
    WriteFramesCsv(frames_, folder_ / "none/t.csv");
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_EQ(e.what(), folder_ / "none/t.csv" + ": No such file or directory");
  }
}

}  // namespace
}  // namespace visavis
