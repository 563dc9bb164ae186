// The refined estimator with two faces in view.
#include <gtest/gtest.h>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

double FrozenTime() { return 0; }

struct Faces {
  Vector6d one, other;
};
const Faces kFaces[] = {{PhiOf(-130, 10, 1000, 3, -6, 4), PhiOf(150, -20, 1020, -4, 8, -3)},
                        {PhiOf(-150, -40, 1150, 0, 10, 0), PhiOf(120, 50, 950, 5, 0, 6)},
                        {PhiOf(-110, 0, 930, -6, 4, -8), PhiOf(180, 20, 1180, 2, -9, 5)}};

class TwoFacesTest : public ::testing::Test {
 protected:
  static RecogniserConfig Config() {
    RecogniserConfig config;
    config.search.preset = "custom";
    config.search.min_x_mm = -250;
    config.search.max_x_mm = 250;
    return config;
  }
  /// What is found in the first frame by an estimator that is told where to take a face.
  Estimate First(const Faces& faces, std::vector<double> nearest_to, std::uint64_t seed = 1) {
    RecogniserConfig config = Config();
    config.search.nearest_to = std::move(nearest_to);
    RefinedSettings settings = config.RefinedSettings();
    settings.seed = seed;
    estimator_ = std::make_unique<RefinedEstimator>(settings, HeadGeometry{}, TestRig());
    Show(faces);
    return See();
  }
  void Show(const Faces& faces) {
    scene_.ShowAll({TransformFromPhi(faces.one), TransformFromPhi(faces.other)}, FeaturedHead);
  }
  Estimate See() {
    StereoFrame frame;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    return estimator_->Process(frame, {}, &timer_);
  }
  static void ExpectAt(const Vector6d& phi, const Estimate& estimate) {
    EXPECT_EQ(estimate.status, TrackStatus::kTracking);
    ASSERT_TRUE(estimate.X_CM);
    const auto error = ComputeRecognitionError(TransformFromPhi(phi), *estimate.X_CM);
    EXPECT_LT(1e3 * error.position.norm(), 6);
    EXPECT_LT(error.total_angle * 180 / M_PI, 3);
  }
  static std::vector<double> Beside(const Vector6d& phi) {
    return {phi[0] + 0.03, phi[1] - 0.04, phi[2] + 0.05};
  }

  MeshScene scene_{TestRig()};
  std::unique_ptr<RefinedEstimator> estimator_;
  StageTimer timer_{&FrozenTime};
};

TEST_F(TwoFacesTest, TheOneNearestToThePlaceThatIsSetIsTakenAtTheStart) {
  for (const Faces& faces : kFaces) {
    ExpectAt(faces.one, First(faces, Beside(faces.one)));
    ExpectAt(faces.other, First(faces, Beside(faces.other)));
  }
}

TEST_F(TwoFacesTest, WhicheverTheSearchComesUponFirst) {
  for (std::uint64_t seed = 2; seed < 5; ++seed) {
    ExpectAt(kFaces[0].one, First(kFaces[0], Beside(kFaces[0].one), seed));
    ExpectAt(kFaces[0].other, First(kFaces[0], Beside(kFaces[0].other), seed));
  }
}

TEST_F(TwoFacesTest, ItStaysTheOneThatIsTrackedThoughTheOtherComesNearerToThePlace) {
  Faces faces = kFaces[0];
  ExpectAt(faces.one, First(faces, Beside(faces.one)));
  for (int i = 0; i < 12; ++i) {
    faces.one += PhiOf(-6, 0, 0, 0, 0, 0);
    faces.other += PhiOf(-16, 0, 0, 0, 0, 0);
    Show(faces);
    const Estimate estimate = See();
    ExpectAt(faces.one, estimate);
  }
}

TEST_F(TwoFacesTest, WithoutAPlaceOneOfThemIsTaken) {
  for (const Faces& faces : kFaces) {
    const Estimate estimate = First(faces, {});
    const bool is_one = estimate.X_CM->translation().x() < 0;
    ExpectAt(is_one ? faces.one : faces.other, estimate);
  }
}

TEST_F(TwoFacesTest, AFaceFarFromThePlaceIsTakenWhereItIsTheOnlyOne) {
  const Faces& faces = kFaces[0];
  const Vector6d away = PhiOf(3000, 0, 1000, 0, 0, 0);
  ExpectAt(faces.one, First({faces.one, away}, Beside(faces.other)));
}

}  // namespace
}  // namespace visavis
