#include "services/arm_state/sources/csv_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class CsvSourceTest : public ::testing::Test {
 protected:
  SourceContext Context(const std::string& text, bool live) {
    std::ofstream(folder_ / "arm.csv") << text;
    return {nullptr, &clock_, live, "", folder_ / "arm.csv", [this](const JointReading& reading) {
              readings_.push_back(reading);
            }};
  }
  void ExpectRefused(const std::string& text, const std::string& why) {
    EXPECT_THAT([&] { CsvSource source(Context(text, true)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  }
  const TemporaryFolder folder_;
  ManualClock clock_;
  std::vector<JointReading> readings_;
};

constexpr char kThree[] =
    "frame,time_s,lift,note,turn\r\n"
    "0,10.000,0.1,start,1.5\r\n"
    "1,10.010,0.2,,1.25\r\n"
    "2,10.025,0.3,end,1\r\n";

TEST_F(CsvSourceTest, LiveTheFirstRowComesAtOnceAndTheOthersAtTheirDistances) {
  clock_.Set(1'700'000'000'000'000);
  CsvSource source(Context(kThree, true));
  EXPECT_EQ(source.next_wake_us(), 1'700'000'000'000'000);
  source.Wake();
  ASSERT_EQ(readings_.size(), 1u);
  EXPECT_EQ(readings_[0].utime_us, 1'700'000'000'000'000);
  EXPECT_THAT(readings_[0].names, ElementsAre("lift", "turn"));
  EXPECT_THAT(readings_[0].position, ElementsAre(0.1, 1.5));
  EXPECT_TRUE(readings_[0].velocity.empty());
  EXPECT_EQ(source.next_wake_us(), 1'700'000'000'010'000);
  EXPECT_FALSE(source.finished());
  clock_.Set(1'700'000'000'025'000);  // late: both that are due
  source.Wake();
  ASSERT_EQ(readings_.size(), 3u);
  EXPECT_EQ(readings_[2].utime_us, 1'700'000'000'025'000);
  EXPECT_THAT(readings_[2].position, ElementsAre(0.3, 1.0));
  EXPECT_TRUE(source.finished());
  EXPECT_EQ(source.next_wake_us(), ArmSource::kNever);
}

TEST_F(CsvSourceTest, InAReplayItsTimesAreTheLogs) {
  CsvSource source(Context(kThree, false));
  EXPECT_EQ(source.next_wake_us(), 10'000'000);
  clock_.Set(10'010'000);
  source.Wake();
  ASSERT_EQ(readings_.size(), 2u);
  EXPECT_EQ(readings_[1].utime_us, 10'010'000);
}

TEST_F(CsvSourceTest, BadFilesAreRefusedWithLineColumnAndRule) {
  ExpectRefused("lift\n1\n", "time_s");
  ExpectRefused("time_s,lift\n", "arm.csv: must have rows");
  ExpectRefused("time_s,note\n1,a\n", "arm.csv:1: no joints: must have a column per joint");
  ExpectRefused("time_s,lift\n1,1\n1,2\n", "arm.csv:3: time_s: 1: must be later");
  ExpectRefused("time_s,lift\n-1,1\n", "arm.csv:2: time_s: -1: must be >= 0");
  ExpectRefused("time_s,lift\n1,1\n2,x\n", "arm.csv:3: lift: x:");
  SourceContext nowhere = Context("", true);
  nowhere.file = folder_ / "none.csv";
  EXPECT_THAT([&] { CsvSource source(nowhere); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("none.csv")));
}

}  // namespace
}  // namespace visavis
