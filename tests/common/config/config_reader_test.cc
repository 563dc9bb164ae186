#include "common/config/config_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/config/config_writer.h"
#include "common/core/random.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

struct Inner {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("min_mm", &min_mm, InRange(-500.0, 500.0, "mm"));
    a->Visit("max_mm", &max_mm);
  }
  double min_mm{-200}, max_mm{200};
};

struct Config {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("mode", &mode, OneOf({"none", "exact"}));
    a->Visit("count", &count, InRange(1, 10));
    a->Visit("search", &search);
    a->Visit("list", &list);
  }
  void ValidateOrThrow() const {
    if (!(search.min_mm < search.max_mm)) {
      throw FieldError("search.max_mm", std::to_string(search.max_mm), "must exceed search.min_mm");
    }
  }
  std::string mode{"exact"};
  int count{3};
  Inner search;
  std::vector<double> list{1, 2};
};

std::string WriteFile(const std::string& text) {
  const std::string name = ::testing::TempDir() + "/config_reader_test.yaml";
  std::ofstream(name) << text;
  return name;
}

auto ThrowsConfigError(const ::testing::Matcher<const std::string&>& matcher) {
  return ThrowsMessage<ConfigError>(matcher);
}

TEST(ConfigReaderTest, AMissingKeyKeepsItsDefault) {
  const auto config = LoadConfig<Config>(WriteFile("search: {min_mm: -100}\n"));
  EXPECT_EQ(config.search.min_mm, -100);
  EXPECT_EQ(config.search.max_mm, 200);
  EXPECT_EQ(config.count, 3);
}

struct Listed {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("parts", &parts);
  }
  void ValidateOrThrow() const {}
  std::vector<Inner> parts;
};

TEST(ConfigReaderTest, AListOfMappingsIsReadInOrderEachWithItsDefaults) {
  const auto config = LoadConfig<Listed>(WriteFile("parts:\n- {min_mm: 1}\n- {max_mm: 2}\n"), {});
  ASSERT_EQ(config.parts.size(), 2u);
  EXPECT_EQ(config.parts[0].min_mm, 1);
  EXPECT_EQ(config.parts[0].max_mm, 200);
  EXPECT_EQ(config.parts[1].max_mm, 2);
  EXPECT_EQ(YAML::Load(DumpConfig(config))["parts"][1]["max_mm"].as<double>(), 2);
}

TEST(ConfigReaderTest, AWrongMemberOfAListIsNamedByItsPlace) {
  EXPECT_THAT([] { LoadConfig<Listed>(WriteFile("\nparts: [{}, {min_mm: 900}]\n")); },
              ThrowsConfigError(HasSubstr("config_reader_test.yaml:2: parts.1.min_mm: 900: must")));
  EXPECT_THAT([] { LoadConfig<Listed>("", {"parts=[{min: 3}]"}); },
              ThrowsConfigError(HasSubstr("--set parts=[{min: 3}]: parts.0.min: 3: unknown key")));
  EXPECT_THAT([] { LoadConfig<Listed>(WriteFile("parts: [3]\n")); },
              ThrowsConfigError(HasSubstr("parts.0: 3: must be a mapping")));
  EXPECT_THAT([] { LoadConfig<Listed>(WriteFile("parts: {min_mm: 3}\n")); },
              ThrowsConfigError(HasSubstr("must be a list of mappings")));
}

TEST(ConfigReaderTest, AnEmptyFileGivesTheDefaults) {
  EXPECT_EQ(LoadConfig<Config>(WriteFile("")).mode, "exact");
}

TEST(ConfigReaderTest, AnUnknownKeyIsNamedWithFileAndLine) {
  EXPECT_THAT(
      [] { LoadConfig<Config>(WriteFile("count: 5\nsearch:\n  min: 3\n")); },
      ThrowsConfigError(AllOf(HasSubstr("config_reader_test.yaml:3: search.min: 3: unknown key"),
                              HasSubstr("min_mm"))));
}

TEST(ConfigReaderTest, AValueOutOfRangeIsNamedWithItsRule) {
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("\ncount: 0\n")); },
              ThrowsConfigError(HasSubstr("config_reader_test.yaml:2: count: 0: must be 1 to 10")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("search: {min_mm: .nan}\n")); },
              ThrowsConfigError(HasSubstr("must be -500 to 500 mm")));
}

TEST(ConfigReaderTest, AWrongTypeIsNamed) {
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("count: many\n")); },
              ThrowsConfigError(HasSubstr("count: many: must be a whole number")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("search: 3\n")); },
              ThrowsConfigError(HasSubstr("search: 3: must be a mapping")));
}

TEST(ConfigReaderTest, ARuleBetweenKeysCarriesThePlaceOfItsKey) {
  EXPECT_THAT(
      [] { LoadConfig<Config>(WriteFile("count: 2\nsearch:\n  min_mm: 9\n  max_mm: 4\n")); },
      ThrowsConfigError(HasSubstr("yaml:4: search.max_mm: 4.0")));
}

TEST(ConfigReaderTest, OverridesWinAndAreNamedInErrors) {
  const auto config = LoadConfig<Config>(WriteFile("count: 5\n"), {"count=7", "search.min_mm=-9"});
  EXPECT_EQ(config.count, 7);
  EXPECT_EQ(config.search.min_mm, -9);
  EXPECT_THAT(
      [] { LoadConfig<Config>("", {"mode=fast"}); },
      ThrowsConfigError(HasSubstr("--set mode=fast: mode: fast: must be one of none exact")));
  EXPECT_THAT([] { LoadConfig<Config>("", {"mode"}); }, ThrowsConfigError(HasSubstr("KEY=VALUE")));
  EXPECT_THAT([] { LoadConfig<Config>("", {"nothing.at.all=1"}); },
              ThrowsConfigError(HasSubstr("--set nothing.at.all=1")));
}

struct NamesFile {
  template <typename A>
  void Serialize(A* a) {
    a->VisitFile("rig_file", &rig_file);
  }
  std::string rig_file{"default.yaml"};
};

struct NamesFiles {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("inner", &inner);
    a->VisitFile("folder", &folder);
  }
  void ValidateOrThrow() const {}
  NamesFile inner;
  std::string folder;
};

TEST(ConfigReaderTest, AFileIsRelativeToTheFileThatNamesItAndOfAFlagToWhereTheProgramRuns) {
  const auto file = WriteFile("inner: {rig_file: rigs/a.yaml}\nfolder: /data\n");
  auto config = LoadConfig<NamesFiles>(file);
  EXPECT_EQ(config.inner.rig_file, std::filesystem::path(file).parent_path() / "rigs/a.yaml");
  EXPECT_EQ(config.folder, "/data");
  config = LoadConfig<NamesFiles>(file, {"inner={rig_file: b.yaml}", "folder=c"});
  EXPECT_EQ(config.inner.rig_file, "b.yaml");
  EXPECT_EQ(config.folder, "c");
  config = LoadConfig<NamesFiles>(WriteFile("folder: ''\n"));
  EXPECT_EQ(config.inner.rig_file, "default.yaml");
  EXPECT_EQ(config.folder, "");
  EXPECT_EQ(ConfigSource::FromText("{}", "beside.yaml").FileOf("folder", "c"), "c");
}

TEST(ConfigReaderTest, AMissingFileAndBrokenYamlAreNamed) {
  EXPECT_THAT([] { LoadConfig<Config>("/nowhere/x.yaml"); },
              ThrowsConfigError(HasSubstr("/nowhere/x.yaml: cannot be read")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("count: [1\n")); },
              ThrowsConfigError(HasSubstr("is no YAML")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("- 1\n")); },
              ThrowsConfigError(HasSubstr("mapping")));
}

TEST(ConfigReaderTest, AFolderAndASecondDocumentAreRefused) {
  EXPECT_THAT([] { LoadConfig<Config>(::testing::TempDir()); },
              ThrowsConfigError(HasSubstr(": cannot be read")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("count: 2\n---\ncount: 3\n")); },
              ThrowsConfigError(HasSubstr("must be one YAML document")));
}

TEST(ConfigReaderTest, AKeyGivenTwiceIsNamedWithItsSecondLine) {
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("count: 2\nmode: none\ncount: 3\n")); },
              ThrowsConfigError(HasSubstr("yaml:3: count: 3: must not be given twice")));
  EXPECT_THAT([] { LoadConfig<Config>(WriteFile("search: {min_mm: 1, min_mm: 1}\n")); },
              ThrowsConfigError(HasSubstr("search.min_mm: 1: must not be given twice")));
}

TEST(ConfigReaderTest, NoTextMakesItDoAnythingButReadOrRefuse) {
  const std::string good =
      "mode: none\ncount: 4\nsearch: {min_mm: -1, max_mm: 2}\nlist: [1, 2.5]\n";
  Random random(1);
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    std::string text = good;
    for (int k = random.Index(4); k >= 0; --k) {
      const auto at = static_cast<std::size_t>(random.Index(static_cast<int>(text.size())));
      const char odd[] =
          "{}[]:,-&*!|>'\"%@`#\n\t \xff\x01"
          "19a.";
      if (random.Index(3) == 0) {
        text.erase(at, 1 + static_cast<std::size_t>(random.Index(5)));
      } else {
        text.insert(at, 1, odd[random.Index(static_cast<int>(sizeof odd) - 1)]);
      }
      if (text.empty()) text = " ";
    }
    try {
      LoadConfig<Config>(WriteFile(text));
    } catch (const ConfigError& e) {
      EXPECT_THAT(e.what(), HasSubstr("config_reader_test.yaml")) << text;
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

TEST(ConfigWriterTest, WhatIsWrittenReadsBackEqual) {
  Config config;
  config.count = 9;
  config.search.max_mm = 123.5;
  const auto read = LoadConfig<Config>(WriteFile(DumpConfig(config)));
  EXPECT_EQ(DumpConfig(read), DumpConfig(config));
  EXPECT_EQ(read.search.max_mm, 123.5);
}

}  // namespace
}  // namespace visavis
