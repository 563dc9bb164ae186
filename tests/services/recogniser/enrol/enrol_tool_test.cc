// What visavis-enrol refuses, on logs of a few painted pairs. What it makes of a person is told by
// the test of the whole program.
#include "services/recogniser/enrol/enrol_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/convert/image_message.h"
#include "common/convert/rig_message.h"
#include "tests/support/log_writing.h"
#include "tests/support/stereo_scene.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class EnrolToolTest : public ::testing::Test {
 protected:
  /// A log of @p pairs pairs of an empty wall. @return its name.
  std::string WallLog(int pairs, bool with_rig = true) {
    EventLogWriter writer(log_, EventLogWriter::Mode::kReplace);
    if (with_rig) {
      WriteMessage("STEREO_RIG", ToMessage({SmallRig(), std::nullopt, std::nullopt}, 0), &writer);
    }
    const OwnedImage wall = FlatImage(320, 240, 96, 140, 176);
    for (int i = 0; i < pairs; ++i) {
      images_t message{};
      message.utime = 33'333 * i;
      message.n_images = 2;
      message.image_types = {images_t::LEFT, images_t::RIGHT};
      message.images.resize(2);
      for (image_t& image : message.images) SetImage(wall.view, message.utime, &image);
      WriteMessage("STEREO_IMAGES", message, &writer);
    }
    writer.Close();
    return log_;
  }
  /// Runs the tool; it must fail with @p exit_code and one line, which is returned, and write no
  /// head.
  std::string Refusal(std::vector<std::string> arguments, int exit_code) {
    arguments.insert(arguments.begin(), "visavis-enrol");
    std::vector<const char*> argv;
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    std::ostringstream out, err;
    EXPECT_EQ(RunEnrolTool(static_cast<int>(argv.size()), argv.data(), out, err), exit_code);
    const std::string line = err.str();
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
    EXPECT_EQ(out.str(), "");
    EXPECT_FALSE(std::filesystem::exists(head_));
    return line;
  }

  const TemporaryFolder folder_;
  const std::string log_ = folder_ / "wall.lcm", head_ = folder_ / "head.yaml";
};

TEST_F(EnrolToolTest, ALogWithoutAFaceIsRefusedAndNoFileIsWritten) {
  EXPECT_THAT(Refusal({WallLog(8), "-o", head_}, 2),
              AllOf(HasSubstr("wall.lcm"), HasSubstr("a face in 0 of 8 pairs"),
                    HasSubstr("at least 3 directions")));
}

TEST_F(EnrolToolTest, ALogWithoutPairsIsRefused) {
  EXPECT_THAT(Refusal({WallLog(0), "-o", head_}, 2), HasSubstr("0 of 0 pairs"));
}

TEST_F(EnrolToolTest, ALogWithoutARigFailsByTheChannelsName) {
  EXPECT_THAT(Refusal({WallLog(3, false), "-o", head_}, 1),
              AllOf(HasSubstr("wall.lcm"), HasSubstr("STEREO_RIG")));
  // The channel is the settings'.
  EXPECT_THAT(Refusal({log_, "-o", head_, "--set", "channels.stereo_rig=MY_RIG"}, 1),
              HasSubstr("MY_RIG"));
}

TEST_F(EnrolToolTest, WhatIsNoLogFailsByItsName) {
  const std::string text = folder_ / "text.lcm";
  std::ofstream(text) << "not a log, but long enough to look for an event in it";
  EXPECT_THAT(Refusal({text, "-o", head_}, 1), HasSubstr("text.lcm"));
  EXPECT_THAT(Refusal({folder_ / "nowhere.lcm", "-o", head_}, 2), HasSubstr("nowhere.lcm"));
}

// Before the recording is read: that takes its time.
TEST_F(EnrolToolTest, AnOutputThatCannotBeWrittenIsToldAtOnce) {
  const std::string none = folder_ / "none/head.yaml";
  EXPECT_THAT(Refusal({WallLog(3), "-o", none}, 1),
              AllOf(HasSubstr("none/head.yaml"), HasSubstr("cannot be written")));
  EXPECT_THAT(Refusal({log_, "-o", folder_.path().string()}, 1), HasSubstr("cannot be written"));
}

TEST_F(EnrolToolTest, AHeadThatWasThereStaysWhereTheNewOneFails) {
  const std::string old = folder_ / "old.yaml";
  std::ofstream(old) << "old\n";
  Refusal({WallLog(3), "-o", old}, 2);
  std::ifstream file(old);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "old\n");
}

TEST_F(EnrolToolTest, TheRecordingItselfIsRefusedAsTheOutputAndStays) {
  const auto size = std::filesystem::file_size(WallLog(3));
  const std::string link = folder_ / "link.yaml";
  std::filesystem::create_symlink(log_, link);
  for (const std::string& output : {log_, link}) {
    EXPECT_THAT(Refusal({log_, "-o", output}, 2), AllOf(HasSubstr("--output"), HasSubstr(output)));
  }
  EXPECT_EQ(std::filesystem::file_size(log_), size);
}

TEST_F(EnrolToolTest, BadFlagsAndSettingsExitWith2ByName) {
  WallLog(1);
  EXPECT_THAT(Refusal({log_}, 2), HasSubstr("--output"));
  EXPECT_THAT(Refusal({"-o", head_}, 2), HasSubstr("LOG"));
  EXPECT_THAT(Refusal({log_, "-o", head_, "--set", "refined.iterations=1"}, 2),
              HasSubstr("refined.iterations"));
  EXPECT_THAT(
      Refusal({log_, "-o", head_, "--set", "refined.head.file=" + (folder_ / "no.yaml")}, 2),
      HasSubstr("no.yaml"));
}

}  // namespace
}  // namespace visavis
