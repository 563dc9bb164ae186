#include "common/tool/run_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Result {
  int exit_code;
  std::string out, err;
};

/// Runs a tool "visavis-x" whose work is @p work, with these arguments.
template <typename Work>
Result RunWith(const std::vector<const char*>& args, Work work) {
  CLI::App app("Does x.", "visavis-x");
  int number = 0;
  app.add_option("--number", number, "a number");
  std::ostringstream out, err;
  app.callback([&] { work(out); });
  std::vector<const char*> argv{"visavis-x"};
  argv.insert(argv.end(), args.begin(), args.end());
  const int exit_code = RunTool(&app, static_cast<int>(argv.size()), argv.data(), out, err);
  return {exit_code, out.str(), err.str()};
}

TEST(RunToolTest, WorkThatEndsWellExitsWith0) {
  const Result result = RunWith({"--number", "3"}, [](std::ostream& out) { out << "done\n"; });
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.out, "done\n");
  EXPECT_EQ(result.err, "");
}

TEST(RunToolTest, BadInputExitsWith2AndOneLine) {
  const Result result =
      RunWith({}, [](std::ostream&) { throw std::invalid_argument("a.csv:3: x: bad: rule"); });
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.err, "visavis-x: a.csv:3: x: bad: rule\n");
}

TEST(RunToolTest, AFailureOnTheWayExitsWith1) {
  const Result result =
      RunWith({}, [](std::ostream&) { throw std::runtime_error("a.lcm: No space left"); });
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "visavis-x: a.lcm: No space left\n");
}

TEST(RunToolTest, BadFlagsExitWith2AndDoNoWork) {
  bool worked = false;
  for (const auto& args :
       {std::vector<const char*>{"--bogus"}, std::vector<const char*>{"--number", "three"},
        std::vector<const char*>{"--number"}}) {
    const Result result = RunWith(args, [&](std::ostream&) { worked = true; });
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, StartsWith("visavis-x: "));
    EXPECT_THAT(result.err, HasSubstr("(--help shows the flags)\n"));
    EXPECT_EQ(result.out, "");
  }
  EXPECT_FALSE(worked);
}

TEST(RunToolTest, HelpAndVersionGoToStandardOutput) {
  bool worked = false;
  const Result help = RunWith({"--help"}, [&](std::ostream&) { worked = true; });
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("--number"));
  const Result version = RunWith({"--version"}, [&](std::ostream&) { worked = true; });
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("visavis-x "));
  EXPECT_FALSE(worked);
}

TEST(RunToolTest, OutputThatCannotBeWrittenIsAFailure) {
  const Result result = RunWith({}, [](std::ostream& out) { out.setstate(std::ios::badbit); });
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("cannot write to standard output"));
}

}  // namespace
}  // namespace visavis
