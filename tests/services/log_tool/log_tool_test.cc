#include "services/log_tool/log_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/support/sequence_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Result {
  int exit_code;
  std::string out, err;
};

Result RunLog(const std::vector<std::string>& args) {
  std::vector<const char*> argv{"visavis-log"};
  for (const auto& arg : args) argv.push_back(arg.c_str());
  std::ostringstream out, err;
  const int exit_code = RunLogTool(static_cast<int>(argv.size()), argv.data(), out, err);
  return {exit_code, out.str(), err.str()};
}

TEST(LogToolTest, ImportInfoAndExportSayWhatTheyDid) {
  const SequenceFolder folder;
  const TemporaryFolder out;
  const Result import = RunLog({"import", folder.path(), out / "a.lcm"});
  EXPECT_EQ(import.exit_code, 0) << import.err;
  EXPECT_THAT(import.out, HasSubstr("4 frames in 0.300 s, 3 with truth, 4 camera poses"));
  const Result info = RunLog({"info", out / "a.lcm"});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.out, HasSubstr("visavis.images_t"));
  const Result exported = RunLog({"export", out / "a.lcm", out / "folder"});
  EXPECT_EQ(exported.exit_code, 0);
  EXPECT_THAT(exported.out, HasSubstr("4 frames, 4 pictures, 3 with truth"));
}

TEST(LogToolTest, BadUseAndBadInputExitWith2AndOneLine) {
  const SequenceFolder folder;
  const TemporaryFolder out;
  folder.Replace("truth.csv", "-0.13", "nan");
  for (const auto& args :
       std::vector<std::vector<std::string>>{{},
                                             {"bogus"},
                                             {"import", folder.path()},
                                             {"import", folder.path(), out / "a.lcm"},
                                             {"import", out / "none", out / "a.lcm"},
                                             {"import", "--bogus", folder.path(), out / "a.lcm"},
                                             {"export", out / "none.lcm", out / "folder"},
                                             {"export", folder.File("rig.yaml"), out / "folder"},
                                             {"info", out / "none.lcm"},
                                             {"info", folder.path()}}) {
    const Result result = RunLog(args);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(args);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, StartsWith("visavis-log: "));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_TRUE(std::filesystem::is_empty(out.path()));
}

TEST(LogToolTest, AnOutputThatCannotBeWrittenExitsWith1) {
  const SequenceFolder folder;
  const Result result = RunLog({"import", folder.path(), folder.File("none/a.lcm")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("No such file or directory"));
}

TEST(LogToolTest, HelpAndVersionExitWith0) {
  const Result help = RunLog({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("import"));
  const Result version = RunLog({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("visavis-log "));
}

}  // namespace
}  // namespace visavis
