#include "services/logger/log_name.h"

#include <gtest/gtest.h>

#include <ctime>

#include "common/core/random.h"

namespace visavis {
namespace {

TEST(LogNameTest, NamesSortByTimeInUtc) {
  EXPECT_EQ(LogName("visavis", 0, 0), "visavis-19700101T000000Z.lcm");
  EXPECT_EQ(LogName("run", 1'732'295'101'999'999, 0), "run-20241122T170501Z.lcm");
  EXPECT_EQ(LogName("run", 1'732'295'101'999'999, 2), "run-20241122T170501Z-2.lcm");
}

TEST(LogNameTest, DatesAreThoseOfTheCLibrary) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const std::time_t seconds = static_cast<std::time_t>(random.Uniform() * 7e9);  // to 2191
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    char expected[32];
    std::strftime(expected, sizeof expected, "a-%Y%m%dT%H%M%SZ.lcm", &utc);
    EXPECT_EQ(LogName("a", 1'000'000 * static_cast<std::int64_t>(seconds), 0), expected);
  }
}

}  // namespace
}  // namespace visavis
