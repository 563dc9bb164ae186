#pragma once

#include <gtest/gtest.h>

#include <string>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "tests/support/environment.h"

namespace visavis {

/// A file of the source, e.g. "services/logger/logger.yaml".
inline std::string ShippedFile(const std::string& path) {
  return Environment("VISAVIS_SOURCE_DIR") + "/" + path;
}

/// Every key of @p expected is in @p actual, maps within maps too.
inline void ExpectSameKeys(const YAML::Node& expected, const YAML::Node& actual,
                           const std::string& prefix = "") {
  for (const auto& entry : expected) {
    const auto key = entry.first.as<std::string>();
    ASSERT_TRUE(actual[key].IsDefined()) << prefix << key;
    if (entry.second.IsMap()) ExpectSameKeys(entry.second, actual[key], prefix + key + ".");
  }
}

/// The shipped file sets every key, each to its default, and none beside.
template <typename Config>
void ExpectShippedFileHoldsEveryDefault(const std::string& path) {
  const YAML::Node file = YAML::LoadFile(ShippedFile(path));
  const YAML::Node defaults = YAML::Load(DumpConfig(Config{}));
  EXPECT_EQ(DumpConfig(LoadConfig<Config>(ShippedFile(path))), DumpConfig(Config{}));
  EXPECT_GT(defaults.size(), 3u);
  ExpectSameKeys(defaults, file);
  ExpectSameKeys(file, defaults);
}

}  // namespace visavis
