#include "services/simulator/anybody.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr int kMany = 2000;

TEST(AnybodyTest, AllAreValid) {
  for (int i = 1; i <= kMany; ++i) EXPECT_NO_THROW(Anybody(static_cast<std::uint64_t>(i))) << i;
}

TEST(AnybodyTest, TheSameNumberIsTheSamePerson) {
  const Subject a = Anybody(17), b = NamedSubject("anybody_17");
  EXPECT_EQ(b.name, "anybody_17");
  EXPECT_EQ(a.shape.height_mm, b.shape.height_mm);
  EXPECT_EQ(a.complexion.skin, b.complexion.skin);
  EXPECT_NE(a.shape.height_mm, Anybody(18).shape.height_mm);
}

TEST(AnybodyTest, SizesVaryAsAmongAdults) {
  double sum = 0, sum2 = 0;
  std::set<HairStyle::Kind> hair;
  for (int i = 1; i <= kMany; ++i) {
    const Subject s = Anybody(static_cast<std::uint64_t>(i));
    sum += s.shape.height_mm;
    sum2 += s.shape.height_mm * s.shape.height_mm;
    hair.insert(s.hair.kind);
  }
  // Men 230 (9), women 217 (9), as many of each: 223.5 and hypot(9, 6.5) = 11.1, normal deviations
  // cut at two (0.88 of them remain). Standard errors of 2000 draws: 0.23 and 0.17.
  const double mean = sum / kMany, sigma = std::sqrt(sum2 / kMany - mean * mean);
  EXPECT_NEAR(mean, 223.5, 4 * 0.23);
  EXPECT_NEAR(sigma, std::hypot(0.88 * 9, 6.5), 4 * 0.17);
  EXPECT_EQ(hair.size(), 4u);
}

TEST(AnybodyTest, OtherNamesAreRefusedWithTheKnownOnes) {
  for (const char* name :
       {"anybody", "anybody_", "anybody_1x", "anybody_-1", "anybody_1234567890", "nobody_1"}) {
    EXPECT_THAT([&] { NamedSubject(name); },
                ThrowsMessage<std::invalid_argument>(
                    HasSubstr(std::string("subject = ") + name +
                              ": must be one of adult_a, adult_b, adult_c, adult_d, adult_e, "
                              "adult_f, adult_g, adult_h, or anybody_1, anybody_2, ...")));
  }
}

}  // namespace
}  // namespace visavis
