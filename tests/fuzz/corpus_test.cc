#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/fuzz/decode_by_name.h"

namespace visavis {
namespace {

// corpus/TYPE/accepted_WHAT.bin and refused_WHAT.bin: see its README.
TEST(CorpusTest, EveryFileIsAcceptedOrRefusedAsItsNameSays) {
  const char* source = std::getenv("VISAVIS_SOURCE_DIR");
  ASSERT_NE(source, nullptr) << "VISAVIS_SOURCE_DIR: must be set; ctest sets it";
  const auto checks = AllBodyChecks();
  int num_files = 0;
  const std::string corpus = std::string(source) + "/tests/fuzz/corpus";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(corpus)) {
    if (entry.path().extension() != ".bin") continue;
    const std::string type = entry.path().parent_path().filename();
    const std::string name = entry.path().filename();
    ASSERT_EQ(checks.count(type), 1u) << entry.path() << ": its folder must be named like a type";
    const bool must_accept = name.rfind("accepted_", 0) == 0;
    ASSERT_TRUE(must_accept || name.rfind("refused_", 0) == 0) << entry.path();

    std::ifstream file(entry.path(), std::ios::binary);
    const std::vector<std::uint8_t> body{std::istreambuf_iterator<char>(file), {}};
    const DecodeVerdict verdict = checks.at(type)(body, &NumMallocBytes);
    EXPECT_EQ(verdict.fault, "") << entry.path();
    EXPECT_EQ(verdict.accepted, must_accept) << entry.path();
    ++num_files;
  }
  EXPECT_GE(num_files, 100);
}

}  // namespace
}  // namespace visavis
