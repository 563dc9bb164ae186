#include "common/core/provisional_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

std::string Read(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(ProvisionalFileTest, AFileThatIsNotKeptLeavesTheEarlierOne) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "a", "earlier");
  {
    ProvisionalFile file(folder / "a");
    std::ofstream(file.provisional_name()) << "half";
    EXPECT_TRUE(std::filesystem::exists(folder / "a.part"));
  }
  EXPECT_EQ(Read(folder / "a"), "earlier");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.part"));
}

TEST(ProvisionalFileTest, AKeptFileReplacesTheEarlierOne) {
  const TemporaryFolder folder;
  WriteTextFile(folder / "a", "earlier");
  WriteTextFile(folder / "a", "later");
  EXPECT_EQ(Read(folder / "a"), "later");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.part"));
}

TEST(ProvisionalFileTest, FailuresNameTheFile) {
  using ::testing::ThrowsMessage;
  const TemporaryFolder folder;
  EXPECT_THAT([&] { WriteTextFile(folder / "none/a", "text"); },
              ThrowsMessage<std::runtime_error>(folder / "none/a" + ": No such file or directory"));
  std::filesystem::create_directory(folder / "b");
  EXPECT_THAT([&] { WriteTextFile(folder / "b", "text"); },
              ThrowsMessage<std::runtime_error>(folder / "b" + ": Is a directory"));
  EXPECT_FALSE(std::filesystem::exists(folder / "b.part"));
}

}  // namespace
}  // namespace visavis
