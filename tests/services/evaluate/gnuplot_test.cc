#include "services/evaluate/gnuplot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

TEST(GnuplotTest, RunsAScriptAndLeavesNothingButItsOutput) {
  const TemporaryFolder folder;
  const std::string output = folder / "it's here.txt";
  RunGnuplot("set print " + QuoteForGnuplot(output) + "\nprint 6*7\n", folder / "script.gp");
  std::ifstream file(output);
  std::string text;
  std::getline(file, text);
  EXPECT_EQ(text, "42");
  EXPECT_FALSE(std::filesystem::exists(folder / "script.gp"));
}

TEST(GnuplotTest, Utf8DrawsNoWarningWhateverTheLocale) {
  const TemporaryFolder folder;
  setenv("LC_ALL", "POSIX", 1);
  ::testing::internal::CaptureStderr();
  RunGnuplot("set encoding utf8\n", folder / "script.gp");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(GnuplotTest, AScriptThatFailsIsAnError) {
  const TemporaryFolder folder;
  EXPECT_THAT([&] { RunGnuplot("no such command\n", folder / "script.gp"); },
              ::testing::ThrowsMessage<std::runtime_error>(
                  ::testing::StartsWith("gnuplot failed on the figures")));
  EXPECT_FALSE(std::filesystem::exists(folder / "script.gp"));
}

TEST(GnuplotTest, QuotesKeepATextOneConstant) {
  EXPECT_EQ(QuoteForGnuplot("plain"), "'plain'");
  EXPECT_EQ(QuoteForGnuplot("it's"), "'it''s'");
  EXPECT_EQ(QuoteForGnuplot("a\nset output 'x'"), "'aset output ''x'''");
}

}  // namespace
}  // namespace visavis
