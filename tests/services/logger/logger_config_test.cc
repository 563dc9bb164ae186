#include "services/logger/logger_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "tests/support/shipped_config.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(LoggerConfigTest, TheShippedFileHoldsEveryDefault) {
  ExpectShippedFileHoldsEveryDefault<LoggerConfig>("services/logger/logger.yaml");
}

TEST(LoggerConfigTest, BadValuesAreNamed) {
  const auto load = [](const std::string& assignment) {
    return [assignment] { LoadConfig<LoggerConfig>("", {assignment}); };
  };
  EXPECT_THAT(load("include=(HEAD"),
              ThrowsMessage<ConfigError>(
                  AllOf(HasSubstr("include: (HEAD"), HasSubstr("must be a regular expression"))));
  EXPECT_THAT(load("images=some"), ThrowsMessage<ConfigError>(HasSubstr("all jpeg none")));
  EXPECT_THAT(load("name=a/b"), ThrowsMessage<ConfigError>(HasSubstr("name: a/b: must be")));
  EXPECT_THAT(load("name=..hidden"), ThrowsMessage<ConfigError>(HasSubstr("not first")));
  EXPECT_THAT(load("folder=''"), ThrowsMessage<ConfigError>(HasSubstr("must name a folder")));
  EXPECT_THAT(load("flush_ms=0"), ThrowsMessage<ConfigError>(HasSubstr("10 to 60000 ms")));
}

}  // namespace
}  // namespace visavis
