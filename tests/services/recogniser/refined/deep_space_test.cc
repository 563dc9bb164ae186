// The refined estimator in search spaces deeper than an octave, and in wide ones.
#include <gtest/gtest.h>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"
#include "services/recogniser/swap_probe.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

double FrozenTime() { return 0; }

Vector6d PlaceAt(double z_mm) { return PhiOf(20, -20, z_mm, 4, -8, 5); }

class DeepSpaceTest : public ::testing::Test {
 protected:
  DeepSpaceTest() { timer_.Restart(); }

  static RefinedSettings Between(double min_z, double max_z) {
    RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
    settings.space.min[2] = min_z;
    settings.space.max[2] = max_z;
    return settings;
  }
  void Begin(const RefinedSettings& settings) {
    estimator_ = std::make_unique<RefinedEstimator>(settings, HeadGeometry{}, TestRig());
  }
  const Estimate& See() {
    StereoFrame frame;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    return estimator_->Process(frame, {}, &timer_);
  }
  const Estimate& SeeHeadAt(const Vector6d& phi, const Painter& painter = FeaturedHead) {
    scene_.Show(TransformFromPhi(phi), painter);
    return See();
  }
  /// Frames until TRACKING, or @p most.
  int FramesToFind(int most) {
    int frames = 1;
    while (frames < most && See().status != TrackStatus::kTracking) ++frames;
    return frames;
  }
  /// Within what its frame may move by when a head is learned.
  static void ExpectAt(const Vector6d& phi, const Estimate& estimate) {
    EXPECT_EQ(estimate.status, TrackStatus::kTracking) << phi.transpose();
    const auto error = ComputeRecognitionError(TransformFromPhi(phi), *estimate.X_CM);
    EXPECT_LT(1e3 * error.position.norm(), 8 * std::max(1.0, phi[2])) << phi.transpose();
    EXPECT_LT(error.total_angle * 180 / M_PI, 4) << phi.transpose();
  }
  void ExpectTrackedOnTheWay(double z_mm, double to_mm, double factor) {
    for (; (to_mm - z_mm) * (factor - 1) > 0; z_mm *= factor)
      ExpectAt(PlaceAt(z_mm), SeeHeadAt(PlaceAt(z_mm)));
  }

  MeshScene scene_{TestRig()};
  std::unique_ptr<RefinedEstimator> estimator_;
  StageTimer timer_{&FrozenTime};
};

TEST_F(DeepSpaceTest, AHeadIsFoundNearAndFarWithinASearchOfAllParts) {
  Begin(Between(0.4, 3));
  EXPECT_EQ(estimator_->frames_of_a_search(), 3);
  for (const double z_mm : {550.0, 1000.0, 2200.0}) {
    estimator_->Reset();
    scene_.Show(TransformFromPhi(PlaceAt(z_mm)), FeaturedHead);
    EXPECT_LE(FramesToFind(10), 6) << z_mm;
    ExpectAt(PlaceAt(z_mm), See());
  }
}

TEST_F(DeepSpaceTest, AHeadThatWalksIsTrackedThroughAllParts) {
  for (const bool recentre : {true, false}) {
    RefinedSettings settings = Between(0.5, 2.4);
    settings.recentre = recentre;
    Begin(settings);
    SeeHeadAt(PlaceAt(700));
    ExpectTrackedOnTheWay(700, 1900, 1.02);
    ExpectTrackedOnTheWay(1900, 800, 1 / 1.02);
  }
}

TEST_F(DeepSpaceTest, ATrackedFrameAllocatesNothingInAnyPart) {
  if (NumMallocs() < 0) GTEST_SKIP() << "mallocs cannot be counted under a sanitizer";
  RefinedSettings settings = Between(0.5, 2.4);
  settings.refined.learned_views = 0;  // a head that is being learned is allocated for
  Begin(settings);
  for (int i = 0; i < 5; ++i) SeeHeadAt(PlaceAt(1300));
  for (const double factor : {1.02, 1 / 1.02}) {
    for (double z_mm = 1300; z_mm < 1900 && z_mm > 900; z_mm *= factor) {
      scene_.Show(TransformFromPhi(PlaceAt(z_mm)), FeaturedHead);
      if (z_mm == 1300) See();  // back at the start: a search
      const std::int64_t before = NumMallocs();
      See();
      EXPECT_EQ(NumMallocs(), before) << z_mm;
    }
  }
}

TEST_F(DeepSpaceTest, ColoursStayAsLearnedWhenThePartChanges) {
  Begin(Between(0.5, 2.4));  // cut at 0.84 and 1.42 m
  const auto skin = [&] {
    return estimator_->colors()[0].table()[static_cast<std::size_t>(
               ColorModel::BinOf(kSceneSkin[0], kSceneSkin[1], kSceneSkin[2]))] >>
               8 &
           255;
  };
  for (int i = 0; i < 10; ++i) SeeHeadAt(PlaceAt(1480));
  const int before = static_cast<int>(skin());
  for (double z_mm = 1480; z_mm < 1580; z_mm += 4) {
    SeeHeadAt(PlaceAt(z_mm));
    EXPECT_GT(static_cast<int>(skin()), before - 4) << z_mm;
  }
}

TEST_F(DeepSpaceTest, SomebodyElseIsTakenUpAsSoonAsInASpaceOfOnePart) {
  int frames_before = 0;
  for (const RefinedSettings& settings : {Between(0.9, 1.2), Between(0.4, 3)}) {
    Begin(settings);
    for (int i = 0; i < 25; ++i) SeeHeadAt(PlaceAt(1000));
    scene_.Show(TransformFromPhi(PlaceAt(1000)), StrangerHead);
    const int frames = FramesToFind(100);
    if (frames_before == 0) frames_before = frames;
    EXPECT_LE(frames, frames_before + 6);
    ExpectAt(PlaceAt(1000), See());
  }
}

TEST_F(DeepSpaceTest, SomebodyElseAsideIsTakenUpToo) {
  Begin(RecogniserConfig{}.RefinedSettings());
  for (int i = 0; i < 25; ++i) SeeHeadAt(PhiOf(-100, 0, 1050, 4, -8, 5));
  const Vector6d aside = PhiOf(185, 10, 1050, 4, -8, 5);  // out of what is round the last place
  scene_.Show(TransformFromPhi(aside), StrangerHead);
  EXPECT_LE(FramesToFind(60), 45);
  ExpectAt(aside, See());
}

TEST_F(DeepSpaceTest, InGreyAHeadIsFollowedThroughThePartsToo) {
  Begin(Between(0.5, 2.4));
  const auto see = [&](double z_mm) -> const Estimate& {
    scene_.ShowGray(TransformFromPhi(PlaceAt(z_mm)), FeaturedHead);
    return See();
  };
  for (int i = 0; i < 6; ++i) see(900);
  double z_mm = 900;
  while ((z_mm *= 1.03) < 1900) {
    const Estimate& estimate = see(z_mm);
    EXPECT_EQ(estimate.status, TrackStatus::kTracking) << z_mm;
    const auto error = ComputeRecognitionError(TransformFromPhi(PlaceAt(z_mm)), *estimate.X_CM);
    EXPECT_LT(1e3 * error.position.norm(), 30) << z_mm;  // else it would be false
    EXPECT_LT(error.total_angle * 180 / M_PI, 10) << z_mm;
  }
}

TEST_F(DeepSpaceTest, AHeadThatJumpsIsFoundAgain) {
  struct Jump {
    double from_mm, to_mm;
    int frames;  ///< its own part is searched first, its last place and the others by turns
  };
  for (const Jump& jump : {Jump{600, 650, 3}, Jump{1000, 1100, 3}, Jump{2200, 2300, 3},
                           Jump{2200, 600, 10}, Jump{600, 2200, 10}, Jump{1000, 2200, 10}}) {
    Begin(Between(0.4, 3));
    Vector6d place = PlaceAt(jump.from_mm);
    for (int i = 0; i < 25; ++i) SeeHeadAt(place);
    ExpectAt(place, See());
    place = PlaceAt(jump.to_mm);
    place.head<2>() += Eigen::Vector2d(-0.12, 0.05);
    scene_.Show(TransformFromPhi(place), FeaturedHead);
    EXPECT_LE(FramesToFind(20), jump.frames) << jump.from_mm << " to " << jump.to_mm;
    ExpectAt(place, See());
  }
}

TEST_F(DeepSpaceTest, TheNearestFaceIsTakenWhicheverPartItIsIn) {
  RefinedSettings settings = Between(0.5, 2.0);  // cut at 1 m
  settings.space.min[0] = -0.25;
  settings.space.max[0] = 0.25;
  const Vector6d one = PhiOf(-130, 10, 760, 3, -6, 4), other = PhiOf(150, -20, 1150, -4, 8, -3);
  for (const Vector6d& wanted : {one, other}) {
    for (const double aside_m : {-0.12, 0.0, 0.12}) {
      settings.nearest_to_m = wanted.head<3>() + Eigen::Vector3d(0, 0, aside_m);
      Begin(settings);
      scene_.ShowAll({TransformFromPhi(one), TransformFromPhi(other)}, FeaturedHead);
      FramesToFind(6);
      ExpectAt(wanted, See());
    }
  }
}

TEST_F(DeepSpaceTest, SwappedEyesAreNoticedAtAnyDistance) {
  for (const double z_mm : {550.0, 1000.0, 1900.0}) {
    SwapProbe probe([] {
      return std::make_unique<RefinedEstimator>(Between(0.4, 3), HeadGeometry{}, TestRig());
    });
    scene_.Show(TransformFromPhi(PlaceAt(z_mm)), FeaturedHead);
    StereoFrame frame;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    for (int i = 0; i < 6; ++i) probe.Try(frame, &timer_);
    EXPECT_TRUE(probe.found()) << z_mm;
  }
}

TEST_F(DeepSpaceTest, AHeadAtTheEdgeOfAFarSpaceIsFound) {
  RefinedSettings settings = Between(1.7, 3.3);
  settings.space.min[0] = 0.5;  // all on one side
  settings.space.max[0] = 0.75;
  Begin(settings);
  const Vector6d edge = PhiOf(480, 0, 1750, 4, -8, 5);
  scene_.Show(TransformFromPhi(edge), FeaturedHead);
  EXPECT_LE(FramesToFind(10), 6);
  ExpectAt(edge, See());
}

TEST_F(DeepSpaceTest, AnglesMayBeWideOnOneSideOnly) {
  for (const double sign : {-1.0, 1.0}) {
    RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
    settings.space.min.tail<3>().setConstant(-0.3);
    settings.space.max.tail<3>().setConstant(0.3);
    (sign < 0 ? settings.space.min : settings.space.max)[5] = sign;
    Begin(settings);
    const Vector6d place = PhiOf(20, -20, 1050, 4, 5, sign * 44);
    scene_.Show(TransformFromPhi(place), FeaturedHead);
    EXPECT_LE(FramesToFind(10), 6);
    ExpectAt(place, See());
  }
}

}  // namespace
}  // namespace visavis
