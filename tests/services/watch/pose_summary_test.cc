#include "services/watch/pose_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/convert/pose_message.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

head_pose_t Pose(std::int64_t utime, double x_m) {
  RigidTransform X_CM = RigidTransform::Identity();
  X_CM.translation() << x_m, 0, 1;
  head_pose_t pose = TruthMessage(utime, 0, &X_CM);
  pose.fitness = 1.25;
  return pose;
}

TEST(PoseSummaryTest, ErrorIsTheRmsOverPosesWithTruthWhicheverCameFirst) {
  PoseSummary summary;
  summary.AddTruth(Pose(1, 0.000));
  summary.AddPose(Pose(1, 0.003));
  summary.AddPose(Pose(2, 0.004));
  summary.AddTruth(Pose(2, 0.000));
  summary.AddPose(Pose(3, 0.500));                        // no truth
  EXPECT_THAT(summary.Line(1.0), HasSubstr("     3.5"));  // sqrt((9 + 16) / 2)
}

TEST(PoseSummaryTest, PosesOfCamerasWithClocksOfTheirOwnMeetTruthBetweenItsSamples) {
  PoseSummary summary;
  for (int i = 0; i <= 30; ++i) summary.AddTruth(Pose(33'333 * i, 0.001 * i));
  // Their times are 0.1 ms late: by that time the head has moved on by 3 um.
  for (int i = 0; i < 30; ++i) summary.AddPose(Pose(33'333 * i + 100, 0.001 * i + 0.006));
  EXPECT_THAT(summary.Line(1.0), HasSubstr("     6.0"));
}

TEST(PoseSummaryTest, APoseWaitsForTheTruthOfTheNextSecond) {
  PoseSummary summary;
  summary.AddPose(Pose(1, 0.002));
  EXPECT_THAT(summary.Line(1.0), Not(HasSubstr("     2.0")));
  summary.AddTruth(Pose(1, 0.000));
  EXPECT_THAT(summary.Line(1.0), HasSubstr("     2.0"));
}

TEST(PoseSummaryTest, ALineFitsEightyColumnsWhateverTheNumbers) {
  PoseSummary summary;
  summary.AddPose(Pose(1, -1.999));
  summary.AddTruth(Pose(1, 1.999));
  recogniser_timing_t timing{};
  timing.latency_ms = 1234;
  summary.AddTiming(timing);
  EXPECT_LE(summary.Line(0.01).size(), 80u);
  EXPECT_LE(PoseSummary::Header().size(), 80u);
}

TEST(PoseSummaryTest, ASilentSecondSaysSo) {
  PoseSummary summary;
  summary.AddPose(Pose(1, 0.1));
  EXPECT_THAT(summary.Line(1.0), HasSubstr("TRACKING"));
  EXPECT_THAT(summary.Line(1.0), HasSubstr("no pose"));
}

TEST(PoseSummaryTest, AnUnknownPoseShowsDashesAndNoError) {
  PoseSummary summary;
  summary.AddPose(EmptyHeadPose());
  summary.AddTruth(Pose(0, 0.1));
  const std::string line = summary.Line(1.0);
  EXPECT_THAT(line, HasSubstr("-"));
  EXPECT_THAT(line, Not(HasSubstr("nan")));
}

TEST(PoseSummaryTest, RateIsPosesOverTime) {
  PoseSummary summary;
  for (int i = 0; i < 15; ++i) summary.AddPose(Pose(i, 0));
  EXPECT_THAT(summary.Line(0.5), HasSubstr("   30"));
}

}  // namespace
}  // namespace visavis
