// The programs visavis-log and visavis-evaluate as users start them, on the recordings of
// tests/data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"
#include "tests/support/environment.h"
#include "tests/support/sequence_folder.h"
#include "tests/support/temporary_folder.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/images_t.hpp"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string Program(const std::string& name) {
  return Environment("VISAVIS_BIN_DIR") + "/visavis-" + name;
}
std::string Data(const std::string& name) {
  return Environment("VISAVIS_SOURCE_DIR") + "/tests/data/" + name;
}

class ToolsProcessTest : public ::testing::Test {
 protected:
  std::string File(const std::string& name) const { return folder_ / name; }

  /// Imports, replays and evaluates a recording; the JSON of the evaluation.
  nlohmann::json Evaluate(const std::string& recording,
                          const std::vector<std::string>& more = {}) const {
    const auto run = [](const std::vector<std::string>& args) {
      const ProcessResult result = RunProcess(args, {}, std::chrono::seconds(50));
      EXPECT_EQ(result.exit_code, 0) << result.err;
      return result.out;
    };
    run({Program("log"), "import", Data(recording), File("in.lcm")});
    run({Program("recogniser"), "--replay", File("in.lcm"), "--record", File("out.lcm")});
    std::vector<std::string> evaluate = {Program("evaluate"), File("out.lcm"), "--json", "-"};
    evaluate.insert(evaluate.end(), more.begin(), more.end());
    return nlohmann::json::parse(run(evaluate));
  }

  const TemporaryFolder folder_;
};

// A person that no setting was made for, ten jumps over the whole search space.
TEST_F(ToolsProcessTest, ASampleHeadIsFoundAtOnceAndAfterEachJump) {
  const auto json = Evaluate("man_static", {"--align-head-frame"});
  EXPECT_GE(json["share_tracking"], 0.9);
  EXPECT_LE(json["first_lock_s"], 0.67);  // ten frames
  EXPECT_EQ(json["aligned"]["share_false_tracking"], 0);
  EXPECT_LT(json["aligned"]["position_mm"]["norm"]["rmse"], 3);
  EXPECT_LT(json["aligned"]["angle_deg"]["total"]["rmse"], 2.5);
}

TEST_F(ToolsProcessTest, TheShuttleGoesThroughImportReplayAndEvaluate) {
  const auto json = Evaluate("man_shuttle");
  EXPECT_EQ(json["frames"], 12);
  EXPECT_EQ(json["frames_with_truth"], 12);
  EXPECT_EQ(json["recovery_frames"]["count"], 0);  // the camera's own motion is no jump
  // A JPEG file is in the log as it is.
  const auto pairs = ReadMessages<images_t>(File("in.lcm"), "STEREO_IMAGES");
  ASSERT_THAT(pairs, SizeIs(12));
  std::ifstream file(Data("man_shuttle/0031_right.jpg"), std::ios::binary);
  const std::vector<std::uint8_t> jpeg{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(pairs.back().images.at(1).data, jpeg);
  EXPECT_EQ(pairs.front().utime, 1'333'333);
}

TEST_F(ToolsProcessTest, TheStaticPosesGoThroughImportReplayAndEvaluate) {
  const auto json = Evaluate("man_static");
  EXPECT_EQ(json["frames"], 150);
  EXPECT_EQ(json["frames_with_truth"], 150);
  EXPECT_EQ(json["recovery_frames"]["count"], 9);
  // Stock liblcm reads the imported log to its end.
  lcm::LogFile log(File("in.lcm"), "r");
  int events = 0;
  while (log.readNextEvent() != nullptr) ++events;
  EXPECT_EQ(events, 10 + 3 * 150);
}

TEST_F(ToolsProcessTest, ExitCodesAre0Done1Failed2Refused) {
  const auto exit_code = [](const std::vector<std::string>& args) {
    const ProcessResult result = RunProcess(args);
    if (result.exit_code != 0) {
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    return result.exit_code;
  };
  const SequenceFolder folder;
  EXPECT_EQ(exit_code({Program("log"), "--help"}), 0);
  EXPECT_EQ(exit_code({Program("log"), "import", folder.path(), File("a.lcm")}), 0);
  EXPECT_EQ(exit_code({Program("log"), "import", folder.path(), File("none/a.lcm")}), 1);
  EXPECT_EQ(exit_code({Program("log"), "import", File("none"), File("b.lcm")}), 2);
  folder.Replace("truth.csv", "0.8", "nan");
  EXPECT_EQ(exit_code({Program("log"), "import", folder.path(), File("b.lcm")}), 2);
  EXPECT_FALSE(std::filesystem::exists(File("b.lcm")));
  EXPECT_EQ(exit_code({Program("evaluate"), "--version"}), 0);
  EXPECT_EQ(exit_code({Program("evaluate"), File("a.lcm")}), 2);  // no HEAD_POSE
  EXPECT_EQ(exit_code({Program("evaluate"), File("none.lcm")}), 2);
}

TEST_F(ToolsProcessTest, AFullStandardOutputIsAFailure) {
  const SequenceFolder folder;
  const std::string command = Program("log") + " import " + folder.path() + " " + File("a.lcm") +
                              " && exec " + Program("log") + " info " + File("a.lcm") +
                              " > /dev/full";
  const ProcessResult result = RunProcess({"/bin/sh", "-c", command});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("cannot write to standard output"));
}

}  // namespace
}  // namespace visavis
