#include "services/recogniser/track_monitor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/config/config_reader.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr TrackStatus kSearching = TrackStatus::kSearching, kTracking = TrackStatus::kTracking,
                      kLost = TrackStatus::kLost;
constexpr int kConfirm = 3, kLose = 4;

TrackMonitorConfig AConfig() {
  TrackMonitorConfig config;
  config.min_fitness = 0.9;
  config.min_site = 0.1;
  config.min_color = 0.5;
  config.min_feat = 0.1;
  config.keep_fitness = 0.7;
  config.keep_color = 0.4;
  config.keep_feat = 0.05;
  config.border_share = 0.05;
  config.confirm_frames = kConfirm;
  config.lose_frames = kLose;
  config.max_step_mm = 40;
  config.max_step_deg = 12;
  return config;
}

Fitness FitnessOf(double site, double color, double feat) {
  return {site + color + feat, site, color, feat};
}

// +-200 mm, 900 to 1200 mm, +-20 deg.
const SearchSpace kSpace = SearchSpace::FromConfig(SearchSpaceConfig{});
const Fitness kWeak = FitnessOf(0.2, 0.5, 0.07);  // keeps a track, finds none
const Fitness kGood = FitnessOf(0.3, 0.7, 0.3), kBad = FitnessOf(0.3, 0.7, 0.0);

class TrackMonitorTest : public ::testing::Test {
 protected:
  TrackStatus Update(const Fitness& fitness, const Vector6d& phi = PhiOf(0, 0, 1000, 0, 0, 0),
                     const CameraStep& step = {}, bool has_color = true) {
    return monitor_.Update(TransformFromPhi(phi), fitness, has_color, step, kSpace);
  }
  void Track() {
    for (int i = 0; i < kConfirm; ++i) Update(kGood);
    ASSERT_EQ(monitor_.status(), kTracking);
  }
  void Lose() {
    Track();
    for (int i = 0; i < kLose; ++i) Update(kBad);
    ASSERT_EQ(monitor_.status(), kLost);
  }
  TrackMonitor monitor_{AConfig()};
};

TEST_F(TrackMonitorTest, BeginsSearching) { EXPECT_EQ(monitor_.status(), kSearching); }

TEST_F(TrackMonitorTest, TracksAfterTheGivenGoodFramesInARow) {
  for (int i = 1; i < kConfirm; ++i) EXPECT_EQ(Update(kGood), kSearching);
  EXPECT_EQ(Update(kGood), kTracking);
}

TEST_F(TrackMonitorTest, ABadFrameBeforeStartsTheCountAgain) {
  for (int i = 1; i < kConfirm; ++i) Update(kGood);
  EXPECT_EQ(Update(kBad), kSearching);
  for (int i = 1; i < kConfirm; ++i) EXPECT_EQ(Update(kGood), kSearching);
  EXPECT_EQ(Update(kGood), kTracking);
}

TEST_F(TrackMonitorTest, ABadFrameIsLostAtOnce) {
  Track();
  EXPECT_EQ(Update(kBad), kLost);
}

TEST_F(TrackMonitorTest, ATrackIsTakenUpWhereItWasBeforeTheGivenBadFramesAndNotAfter) {
  for (int bad = 1; bad <= kLose; ++bad) {
    monitor_.Reset();
    Track();
    for (int i = 0; i < bad; ++i) Update(kBad);
    EXPECT_EQ(Update(kGood), bad < kLose ? kTracking : kLost) << bad;
  }
}

TEST_F(TrackMonitorTest, WeakerEvidenceKeepsATrackButFindsNone) {
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Update(kWeak), kSearching);
  Track();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Update(kWeak), kTracking);
  const Fitness refused[] = {FitnessOf(0.3, 0.39, 0.3), FitnessOf(0.3, 0.7, 0.049),
                             FitnessOf(0.1, 0.45, 0.14)};
  for (const Fitness& fitness : refused) {
    EXPECT_EQ(Update(fitness), kLost);
    EXPECT_EQ(Update(kWeak), kTracking);
  }
  Lose();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Update(kWeak), kLost);
}

TEST_F(TrackMonitorTest, AHeadExpectedAtAPoseNeedOnlyBeKeptThere) {
  const Vector6d phi = PhiOf(50, 0, 1000, 3, 0, 0);
  monitor_.Expect(TransformFromPhi(phi));
  EXPECT_EQ(Update(kWeak, phi), kTracking);
  // Elsewhere it must be found.
  monitor_.Reset();
  monitor_.Expect(TransformFromPhi(phi));
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Update(kWeak, PhiOf(0, 0, 1000, 3, 0, 0)), kSearching);
}

// border_share: 5 % of 400 mm, of 300 mm in z, of 40 deg.
TEST_F(TrackMonitorTest, AtTheBorderOfTheSearchSpaceNoHeadIsFoundNorKept) {
  const Vector6d at_the_border[] = {PhiOf(181, 0, 1000, 0, 0, 0),   PhiOf(0, -181, 1000, 0, 0, 0),
                                    PhiOf(0, 0, 914, 0, 0, 0),      PhiOf(0, 0, 1000, 18.1, 0, 0),
                                    PhiOf(0, 0, 1000, 0, -18.1, 0), PhiOf(0, 0, 1000, 0, 0, -20),
                                    PhiOf(0, 0, 1000, 0, 0, -18.1)};
  for (const Vector6d& phi : at_the_border) {
    monitor_.Reset();
    for (int i = 0; i < 20; ++i) EXPECT_EQ(Update(kGood, phi), kSearching) << phi.transpose();
    monitor_.Expect(TransformFromPhi(phi));
    EXPECT_EQ(Update(kGood, phi), kSearching) << phi.transpose();
  }
  monitor_.Reset();
  const Vector6d inside = PhiOf(179, -179, 916, 17.9, -17.9, -17.9);
  for (int i = 0; i < kConfirm; ++i) Update(kGood, inside);
  EXPECT_EQ(monitor_.status(), kTracking);
}

TEST(TrackMonitorBorderTest, AShareOfZeroAsksNothing) {
  TrackMonitorConfig config = AConfig();
  config.border_share = 0;
  TrackMonitor monitor(config);
  const RigidTransform X_CM = TransformFromPhi(PhiOf(300, 0, 1000, 0, 0, -20));
  for (int i = 0; i < kConfirm; ++i) monitor.Update(X_CM, kGood, true, {}, kSpace);
  EXPECT_EQ(monitor.status(), kTracking);
}

TEST_F(TrackMonitorTest, NeverGoesFromSearchingToLost) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(Update(kBad), kSearching);
}

TEST_F(TrackMonitorTest, StaysLostUntilTheHeadIsConfirmedAgain) {
  Lose();
  for (int i = 0; i < 50; ++i) EXPECT_EQ(Update(kBad), kLost);
  for (int i = 1; i < kConfirm; ++i) EXPECT_EQ(Update(kGood), kLost);
  EXPECT_EQ(Update(kGood), kTracking);
}

TEST_F(TrackMonitorTest, ResetIsSearchingWithNothingCounted) {
  Lose();
  monitor_.Reset();
  EXPECT_EQ(monitor_.status(), kSearching);
  EXPECT_EQ(monitor_.frames_in_status(), 0);
  // Nor is there a last pose: the first frame may be anywhere.
  const Vector6d elsewhere = PhiOf(150, 0, 1000, 0, 0, 0);
  for (int i = 1; i < kConfirm; ++i) EXPECT_EQ(Update(kGood, elsewhere), kSearching);
  EXPECT_EQ(Update(kGood, elsewhere), kTracking);
}

TEST_F(TrackMonitorTest, CountsTheFramesInAStatus) {
  Track();
  for (int i = 0; i <= 10; ++i) {
    Update(kBad);
    EXPECT_EQ(monitor_.frames_in_status(), i);
  }
}

TEST_F(TrackMonitorTest, CountsTheFramesThatWouldNotEvenKeepAHead) {
  for (int i = 1; i <= 10; ++i) {
    Update(kBad);
    EXPECT_EQ(monitor_.frames_without_head(), i);
  }
  Update(kWeak);
  EXPECT_EQ(monitor_.frames_without_head(), 0);
}

TEST_F(TrackMonitorTest, EveryTermMustReachItsThresholdAtOnce) {
  const Fitness refused[] = {FitnessOf(0.09, 0.9, 0.5), FitnessOf(0.5, 0.49, 0.5),
                             FitnessOf(0.5, 0.9, 0.09), FitnessOf(0.2, 0.55, 0.14)};
  for (const Fitness& fitness : refused) {
    monitor_.Reset();
    for (int i = 0; i < 20; ++i) EXPECT_EQ(Update(fitness), kSearching);
  }
  const Fitness at_the_thresholds[] = {FitnessOf(0.1, 0.75, 0.1), FitnessOf(0.35, 0.5, 0.1)};
  for (const Fitness& fitness : at_the_thresholds) {
    monitor_.Reset();
    for (int i = 0; i < kConfirm; ++i) Update(fitness);
    EXPECT_EQ(monitor_.status(), kTracking);
  }
}

TEST_F(TrackMonitorTest, GrayImagesAreNotAskedForColorNorForTheWholeOfF) {
  const Vector6d phi = PhiOf(0, 0, 1000, 0, 0, 0);
  for (int i = 0; i < kConfirm; ++i) Update(FitnessOf(0.3, 0, 0.3), phi, {}, false);
  EXPECT_EQ(monitor_.status(), kTracking);
  monitor_.Reset();
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(Update(FitnessOf(0.3, 0, 0.09), phi, {}, false), kSearching);
}

TEST_F(TrackMonitorTest, ABestThatJumpsFromPlaceToPlaceIsNeverTracked) {
  Random random(1);
  Vector6d phi = RandomPhi(&random);
  for (int i = 0; i < 500; ++i) {
    Vector6d next = RandomPhi(&random);
    while ((next - phi).head<3>().norm() < 0.041) next = RandomPhi(&random);
    EXPECT_EQ(Update(kGood, next), i == 0 && kConfirm == 1 ? kTracking : kSearching);
    phi = next;
  }
}

TEST_F(TrackMonitorTest, ABestThatOnlyTurnsToAndFroIsNeverTracked) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(Update(kGood, PhiOf(0, 0, 1000, 0, i % 2 ? 13 : 0, 0)), kSearching);
  }
}

TEST_F(TrackMonitorTest, StepsUpToTheLimitsAreGoodAndBeyondBad) {
  const auto tracks = [&](double mm, double deg) {
    monitor_.Reset();
    for (int i = 0; i < kConfirm; ++i) {
      Update(kGood, PhiOf((i - 1) * mm, 0, 1000, (i - 1) * deg, 0, 0));
    }
    return monitor_.status() == kTracking;
  };
  EXPECT_TRUE(tracks(39.9, 0));
  EXPECT_FALSE(tracks(40.1, 0));
  EXPECT_TRUE(tracks(0, 11.9));
  EXPECT_FALSE(tracks(0, 12.1));
  EXPECT_TRUE(tracks(39, 11));
  EXPECT_FALSE(tracks(-41, 0));
}

TEST_F(TrackMonitorTest, ATrackThatJumpsAwayForGoodIsLostUntilItIsConfirmedThere) {
  Track();
  const Vector6d elsewhere = PhiOf(150, 0, 1000, 0, 0, 0);
  for (int i = 0; i < kConfirm; ++i) EXPECT_EQ(Update(kGood, elsewhere), kLost);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(Update(kGood, elsewhere), kTracking);
}

TEST_F(TrackMonitorTest, ABestThatJumpsToAndFroIsTrackedOnlyWhereTheTrackIs) {
  Track();
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(Update(kGood, PhiOf(150, 0, 1000, 0, 0, 0)), kLost);
    EXPECT_EQ(Update(kGood), kTracking);
  }
}

// The camera moves 100 mm and turns 15 deg a frame: the head at rest jumps in the image, but not
// against the camera's own motion.
class MovingCameraTest : public TrackMonitorTest {
 protected:
  static CameraStep Step() {
    CameraStep step;
    step.known = true;
    step.dt_s = 0.033;
    step.X_C2C1 = MakeTransform(ExpRotation({0, 0.26, 0}), Eigen::Vector3d(0.1, 0, 0));
    return step;
  }
  TrackStatus UpdateOfHeadAtRest(const CameraStep& step) {
    X_CM_ = Step().X_C2C1 * X_CM_;
    return UpdateOf(X_CM_, step);
  }
  // In a space without borders.
  TrackStatus UpdateOf(const RigidTransform& X_CM, const CameraStep& step) {
    return monitor_.Update(X_CM, kGood, true, step,
                           {Vector6d::Constant(-1e3), Vector6d::Constant(1e3)});
  }
  RigidTransform X_CM_ = TransformFromPhi(PhiOf(0, 0, 1000, 0, 0, 0));
};

TEST_F(MovingCameraTest, AHeadAtRestIsTrackedWhenTheCamerasStepIsKnown) {
  for (int i = 0; i < kConfirm; ++i) UpdateOfHeadAtRest(Step());
  EXPECT_EQ(monitor_.status(), kTracking);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(UpdateOfHeadAtRest(Step()), kTracking);
}

TEST_F(MovingCameraTest, ATrackIsTakenUpWhereTheCamerasMotionPutItMeanwhile) {
  for (int i = 0; i < kConfirm; ++i) UpdateOfHeadAtRest(Step());
  const RigidTransform X_CM_then = X_CM_;
  for (int i = 1; i < kLose; ++i) {
    X_CM_ = Step().X_C2C1 * X_CM_;
    EXPECT_EQ(UpdateOf(X_CM_then, Step()), kLost);
  }
  EXPECT_EQ(UpdateOfHeadAtRest(Step()), kTracking);
}

TEST_F(MovingCameraTest, TheSameHeadIsNotTrackedWhenTheStepIsUnknown) {
  CameraStep unknown = Step();
  unknown.known = false;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(UpdateOfHeadAtRest(unknown), kSearching);
}

TEST_F(MovingCameraTest, ABestThatStandsStillInTheImageIsNotTracked) {
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(UpdateOf(TransformFromPhi(PhiOf(0, 0, 1000, 0, 0, 0)), Step()), kSearching);
}

struct TrackFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("track", &track);
  }
  void ValidateOrThrow() const {}
  TrackMonitorConfig track;
};

TEST(TrackMonitorConfigTest, EachKeyHoldsItsRange) {
  const std::pair<const char*, const char*> refused[] = {
      {"min_fitness", "3.1"},  {"keep_fitness", "-1.1"}, {"keep_color", "1.1"},
      {"keep_feat", ".inf"},   {"border_share", "0.41"}, {"min_site", "1.1"},
      {"min_color", "-1.1"},   {"min_feat", ".nan"},     {"confirm_frames", "0"},
      {"lose_frames", "1001"}, {"max_step_mm", "0.04"},  {"max_step_deg", "180.1"},
      {"lose_frames", "2.5"}};
  for (const auto& [key, value] : refused) {
    EXPECT_THAT([&] { LoadConfig<TrackFile>("", {std::string("track.") + key + "=" + value}); },
                ::testing::ThrowsMessage<ConfigError>(
                    ::testing::AllOf(::testing::HasSubstr(key), ::testing::HasSubstr(value),
                                     ::testing::HasSubstr("must be"))))
        << key << ' ' << value;
  }
}

}  // namespace
}  // namespace visavis
