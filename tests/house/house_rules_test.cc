#include "tests/house/house_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace visavis {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string Root() {
  const char* source = std::getenv("VISAVIS_SOURCE_DIR");
  if (source == nullptr) throw std::runtime_error("VISAVIS_SOURCE_DIR: must be set; ctest sets it");
  return source;
}

std::string ReadText(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls @p visit with the relative name and text of each file of code below these folders.
template <typename Visit>
int ForEachFile(const std::vector<std::string>& folders, const std::set<std::string>& endings,
                Visit visit) {
  int num_files = 0;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::recursive_directory_iterator(Root() + "/" + folder)) {
      if (!entry.is_regular_file() || endings.count(entry.path().extension()) == 0) continue;
      visit(entry.path().lexically_relative(Root()).generic_string(), ReadText(entry.path()));
      ++num_files;
    }
  }
  return num_files;
}

void Add(const std::vector<Violation>& more, std::vector<Violation>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

class HouseTest : public ::testing::Test {
 protected:
  std::vector<Violation> Includes(const std::string& file, const std::string& header) {
    return CheckIncludes(file, "// first\n#include " + header + "\n", rules_);
  }
  const std::vector<IncludeRule> rules_ =
      ReadIncludeRules(Root() + "/tests/house/include_rules.txt");
};

TEST_F(HouseTest, EveryFileIncludesOnlyWhatItMay) {
  std::vector<Violation> violations;
  const int num_files = ForEachFile({"common", "services"}, {".cc", ".h"},
                                    [&](const std::string& file, const std::string& text) {
                                      Add(CheckIncludes(file, text, rules_), &violations);
                                    });
  EXPECT_GT(num_files, 20);
  EXPECT_TRUE(violations.empty()) << ToText(violations);
}

TEST_F(HouseTest, NoLibraryPrintsOrEndsTheProcess) {
  std::vector<Violation> violations;
  ForEachFile({"common", "services"}, {".cc", ".h"},
              [&](const std::string& file, const std::string& text) {
                Add(CheckPrintsAndExits(file, text), &violations);
              });
  EXPECT_TRUE(violations.empty()) << ToText(violations);
}

TEST_F(HouseTest, NoFileIsLongerThan400Lines) {
  std::vector<Violation> violations;
  ForEachFile({"common", "services", "tests", "lcmtypes", "scripts"},
              {".cc", ".h", ".hpp", ".awk", ".lcm", ".java", ".sh", ".py", ".cmake", ".txt", ""},
              [&](const std::string& file, const std::string& text) {
                Add(CheckLength(file, text), &violations);
              });
  EXPECT_TRUE(violations.empty()) << ToText(violations);
}

TEST_F(HouseTest, WrongIncludesAreFound) {
  EXPECT_EQ(Includes("common/core/x.h", "<Eigen/Core>").size(), 1u);
  EXPECT_EQ(Includes("common/core/x.h", "\"common/geometry/pinhole.h\"").size(), 1u);
  EXPECT_EQ(Includes("common/core/x.cc", "<unistd.h>").size(), 1u);
  EXPECT_EQ(Includes("common/image/x.h", "<opencv2/core.hpp>").size(), 1u);
  EXPECT_EQ(Includes("common/bus/x.h", "\"services/recogniser/estimator.h\"").size(), 1u);
  EXPECT_EQ(Includes("common/bus/x.h", "\"tests/support/malloc_counter.h\"").size(), 1u);
  EXPECT_EQ(Includes("services/logger/x.cc", "\"services/recogniser/estimator.h\"").size(), 1u);
  EXPECT_EQ(Includes("services/recogniser/x.cc", "\"visavis/images_t.hpp\"").size(), 1u);
  EXPECT_EQ(Includes("services/recogniser/x.cc", "<chrono>").size(), 1u);
  EXPECT_EQ(Includes("services/recogniser/x.cc", "\"common/core/clock.h\"").size(), 1u);
  EXPECT_EQ(Includes("services/recogniser/main.cc", "\"common/bus/bus.h\"").size(), 1u);
  EXPECT_EQ(Includes("common/novelty/x.cc", "<vector>").size(), 1u);
  EXPECT_EQ(ToText(Includes("common/core/x.h", "<Eigen/Core>")),
            "common/core/x.h:2: includes <Eigen/Core>: common/core/* may not "
            "(tests/house/include_rules.txt)\n");
}

TEST_F(HouseTest, RightIncludesPass) {
  EXPECT_EQ(Includes("common/core/x.h", "<vector>").size(), 0u);
  EXPECT_EQ(Includes("common/core/x.h", "\"common/core/check.h\"").size(), 0u);
  EXPECT_EQ(Includes("common/image/x.cc", "<opencv2/core.hpp>").size(), 0u);
  EXPECT_EQ(Includes("services/recogniser/x_service.h", "\"visavis/images_t.hpp\"").size(), 0u);
  EXPECT_EQ(Includes("services/recogniser/x.cc", "\"services/recogniser/y.h\"").size(), 0u);
  EXPECT_EQ(Includes("services/recogniser/main.cc", "\"common/service/run_service.h\"").size(), 0u);
}

TEST_F(HouseTest, PrintsAndExitsAreFoundOutsideCommentsAndStrings) {
  const auto faults = [](const std::string& text) {
    return CheckPrintsAndExits("common/core/x.cc", text).size();
  };
  EXPECT_EQ(faults("std::printf(\"x\");\n  std::exit(1);\n"), 2u);
  EXPECT_EQ(faults("assert(x);"), 1u);
  EXPECT_EQ(faults("std::cerr << x;"), 1u);
  EXPECT_EQ(faults("  _exit(1);"), 1u);
  EXPECT_EQ(faults("static_assert(x); std::snprintf(a, 1, b); app.exit(e);"), 0u);
  EXPECT_EQ(faults("// printf(\"x\")\n/* abort()\n */ f(\"exit(1)\"); R\"(assert(x))\";"), 0u);
  EXPECT_EQ(faults("R\"a(\")\" abort() )a\"; int n = 1'000; char c = '\"'; abort();"), 1u);
  EXPECT_EQ(CheckPrintsAndExits("services/a/main.cc", "std::printf(1);").size(), 0u);
  EXPECT_EQ(CheckPrintsAndExits("common/core/x.cc", "\n/* a\n b */\nabort();\n").at(0).line, 4);
}

TEST_F(HouseTest, LongFilesAreFound) {
  EXPECT_EQ(CheckLength("a.cc", std::string(400, '\n')).size(), 0u);
  EXPECT_THAT(ToText(CheckLength("a.cc", std::string(401, '\n'))),
              HasSubstr("a.cc:401: is 401 lines long"));
}

}  // namespace
}  // namespace visavis
