#include "services/recogniser/refined/pose_refiner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "common/config/config_reader.h"
#include "tests/support/malloc_counter.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;
const Vector6d kTruth = PhiOf(20, -10, 1000, 4, -5, 3);

/// Every weight given: tuned defaults move no test.
RefinerConfig TestWeights() {
  RefinerConfig config;
  config.outline_weight = 1;
  config.outline_weight_with_texture = 0.4;
  config.hairline_weight = 0.15;
  config.pattern_weight = 0.4;
  config.texture_weight = 1;
  config.stereo_weight = 1;
  config.stereo_weight_with_texture = 1;
  return config;
}

class PoseRefinerTest : public ::testing::Test {
 protected:
  PoseRefinerTest()
      : scene_(TestRig()),
        X_CM_(TransformFromPhi(kTruth)),
        refiner_(TestWeights(), SharedAdultHead().surface, SharedAdultHead().mesh,
                 SharedAdultHead().face),
        view_(scene_.Show(X_CM_, FeaturedHead)) {}

  RecognitionError ErrorOf(const Refined& refined) const {
    return ComputeRecognitionError(X_CM_, refined.X_CM);
  }

  /// Learned from the true pose under the present pictures.
  FaceTexture Learned() {
    FaceTexture texture(SharedAdultHead().face);
    for (const Band band : {kFineBand, kCoarseBand}) {
      for (std::size_t e = 0; e < 2; ++e)
        texture.Learn(band, refiner_.Sample(view_, e, X_CM_, band, texture));
    }
    return texture;
  }

  MeshScene scene_;
  RigidTransform X_CM_;
  PoseRefiner refiner_;
  const StereoView& view_;
};

std::vector<Vector6d> Starts() {
  return {PhiOf(8, 0, 0, 0, 0, 0), PhiOf(0, -8, 0, 3, 0, 0), PhiOf(5, 5, -8, 0, 3, 0),
          PhiOf(0, 0, 8, 0, 0, -3), PhiOf(-5, 5, 5, -2, 2, 2)};
}

TEST_F(PoseRefinerTest, ConvergesToTheTruePose) {
  for (const Vector6d& aside : Starts()) {
    const Refined refined = refiner_.Refine(view_, TransformFromPhi(kTruth + aside), nullptr, 8, 9);
    const RecognitionError error = ErrorOf(refined);
    EXPECT_LT(error.position.head<2>().norm(), 0.001) << aside.transpose();
    EXPECT_LT(std::abs(error.position.z()), 0.002) << aside.transpose();
    EXPECT_LT(error.total_angle, 1.0 * kDegree) << aside.transpose();
    EXPECT_LT(refined.last_step_m, 0.0005);
    EXPECT_LT(refined.last_step_rad, 0.01);
  }
}

TEST_F(PoseRefinerTest, ConvergesFromOtherPosesToo) {
  for (const Vector6d& truth : {PhiOf(-60, 30, 1100, -6, 8, -4), PhiOf(70, -20, 950, 3, 10, 6)}) {
    X_CM_ = TransformFromPhi(truth);
    scene_.Show(X_CM_, FeaturedHead);
    const RecognitionError error = ErrorOf(
        refiner_.Refine(view_, TransformFromPhi(truth + PhiOf(6, -5, 5, 2, -2, 2)), nullptr, 8, 9));
    EXPECT_LT(error.position.head<2>().norm(), 0.001) << truth.transpose();
    EXPECT_LT(std::abs(error.position.z()), 0.003) << truth.transpose();
    EXPECT_LT(error.total_angle, 1.5 * kDegree) << truth.transpose();
  }
}

TEST_F(PoseRefinerTest, OneEyeMissingStillConverges) {
  for (std::size_t missing = 0; missing < 2; ++missing) {
    StereoView one = view_;
    one[missing].Close();
    const Refined refined =
        refiner_.Refine(one, TransformFromPhi(kTruth + PhiOf(5, -5, 0, 2, 0, 0)), nullptr, 8, 9);
    const RecognitionError error = ErrorOf(refined);
    EXPECT_LT(error.position.head<2>().norm(), 0.0025) << missing;
    EXPECT_LT(std::abs(error.position.z()), 0.02) << missing;
    EXPECT_EQ(refined.stereo_ncc, 0);
  }
}

TEST_F(PoseRefinerTest, WithoutPicturesThePoseStays) {
  StereoView none = view_;
  for (EyeView& eye : none) eye.Close();
  const Refined refined = refiner_.Refine(none, X_CM_, nullptr, 4, 9);
  EXPECT_TRUE(refined.X_CM.isApprox(X_CM_, 1e-12));
  EXPECT_EQ(refined.contour.count, 0);
}

TEST_F(PoseRefinerTest, GreyPicturesAreRefinedAsColouredOnesAre) {
  scene_.ShowGray(X_CM_, GrainyHead);
  const FaceTexture texture = Learned();
  const Refined refined =
      refiner_.Refine(view_, TransformFromPhi(kTruth + PhiOf(2, -1, 3, 0, 0, 0)), &texture, 8, 9);
  EXPECT_GT(refined.contour.count, 20);
  EXPECT_LT(ErrorOf(refined).position.head<2>().norm(), 0.0005);
}

TEST_F(PoseRefinerTest, ALearnedTextureIsFoundAgainToAFractionOfAMillimetre) {
  const FaceTexture texture = Learned();
  const Vector6d truth = kTruth + PhiOf(15, 5, 10, 2, 4, -2);
  X_CM_ = TransformFromPhi(truth);
  scene_.Show(X_CM_, FeaturedHead);
  for (const Vector6d& aside : Starts()) {
    const Refined refined =
        refiner_.Refine(view_, TransformFromPhi(truth + 0.5 * aside), &texture, 8, 9);
    EXPECT_LT(ErrorOf(refined).position.head<2>().norm(), 0.0004) << aside.transpose();
    EXPECT_LT(std::abs(ErrorOf(refined).position.z()), 0.001) << aside.transpose();
    EXPECT_LT(ErrorOf(refined).total_angle, 0.3 * kDegree) << aside.transpose();
    EXPECT_GT(refined.texture_ncc, 0.85);
  }
}

TEST_F(PoseRefinerTest, AnotherFaceDoesNotMatchTheTexture) {
  const FaceTexture texture = Learned();
  EXPECT_GT(refiner_.Refine(view_, X_CM_, &texture, 4, 9).texture_ncc, 0.95);
  scene_.Show(X_CM_, GrainyHead);
  EXPECT_LT(refiner_.Refine(view_, X_CM_, &texture, 4, 9).texture_ncc, 0.6);
}

TEST_F(PoseRefinerTest, TheInformationIsSymmetricPositiveAndAtLeastThePriors) {
  const Refined refined = refiner_.Refine(view_, X_CM_, nullptr, 4, 9);
  const Matrix6d H = refined.information;
  EXPECT_EQ(H, Matrix6d(H.transpose()));
  EXPECT_EQ(H.llt().info(), Eigen::Success);
  const Matrix6d covariance = H.inverse();
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::sqrt(covariance(k, k)), 0.003) << k;
    EXPECT_LT(std::sqrt(covariance(k + 3, k + 3)), 0.1) << k;
  }
}

TEST_F(PoseRefinerTest, AStepIsLimited) {
  RefinerConfig outline;  // which alone asks for long steps
  outline.pattern_weight = outline.stereo_weight = 0;
  PoseRefiner refiner(outline, SharedAdultHead().surface, SharedAdultHead().mesh,
                      SharedAdultHead().face);
  double largest_m = 0, largest_rad = 0;
  for (const Vector6d& aside :
       {PhiOf(0, 0, 120, 0, 0, 0), PhiOf(0, 0, 0, 25, 0, 0), PhiOf(0, 0, 0, -25, 0, 0),
        PhiOf(0, 0, 0, 0, 0, -30), PhiOf(0, 0, 0, 0, 0, 30)}) {
    const RigidTransform start = TransformFromPhi(kTruth + aside);
    const Refined refined = refiner.Refine(view_, start, nullptr, 1, 16);
    EXPECT_LT((refined.X_CM.translation() - start.translation()).norm(), 0.025 + 1e-9);
    EXPECT_LT(LogRotation(start.linear().transpose() * refined.X_CM.linear()).norm(), 0.15 + 1e-9);
    largest_m = std::max(largest_m, refined.last_step_m);
    largest_rad = std::max(largest_rad, refined.last_step_rad);
  }
  EXPECT_GT(largest_m, 0.026);  // some wanted to go further
  EXPECT_GT(largest_rad, 0.16);
}

// X_CM' = X_CM [Exp(w), dp]: the correction brings a displaced frame back.
TEST_F(PoseRefinerTest, TheGenericEquationsCorrectTheFrameInTheHead) {
  for (const Vector6d& aside : {PhiOf(2, 0, 0, 0, 0, 0), PhiOf(0, -2, 0, 0, 0, 0)}) {
    const RigidTransform X = TransformFromPhi(kTruth + aside);
    PoseEquations generic = refiner_.Generic(view_, X);
    EXPECT_LT((generic.H - generic.H.transpose()).norm(), 1e-9 * generic.H.norm());
    generic.AddPrior(0.025, 0.2);
    const Vector6d step = generic.H.ldlt().solve(generic.g);
    const RigidTransform X_MN =
        MakeTransform(ExpRotation(step.tail<3>()), Eigen::Vector3d(step.head<3>()));
    const double before = (X.translation() - X_CM_.translation()).head<2>().norm();
    const double after = ((X * X_MN).translation() - X_CM_.translation()).head<2>().norm();
    EXPECT_LT(after, 0.35 * before);
  }
}

TEST_F(PoseRefinerTest, TheSamePicturesGiveTheSamePoseBitForBit) {
  const RigidTransform start = TransformFromPhi(kTruth + PhiOf(5, 0, 0, 0, 2, 0));
  const Refined first = refiner_.Refine(view_, start, nullptr, 4, 9);
  refiner_.Refine(view_, X_CM_, nullptr, 2, 5);
  const Refined second = refiner_.Refine(view_, start, nullptr, 4, 9);
  EXPECT_EQ(first.X_CM.matrix(), second.X_CM.matrix());
  EXPECT_EQ(first.information, second.information);
}

TEST_F(PoseRefinerTest, RefiningAllocatesNothing) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  const FaceTexture texture = Learned();
  const std::int64_t before = NumMallocs();
  refiner_.Refine(view_, X_CM_, nullptr, 4, 9);
  refiner_.Refine(view_, X_CM_, &texture, 4, 9);
  refiner_.Generic(view_, X_CM_);
  EXPECT_EQ(NumMallocs(), before);
}

struct RefinerFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("refiner", &refiner);
  }
  void ValidateOrThrow() const {}
  RefinerConfig refiner;
};

TEST(RefinerConfigTest, WeightsBeyondTheirRangeAreRefusedByName) {
  for (const std::string key :
       {"outline_weight", "outline_weight_with_texture", "hairline_weight", "pattern_weight",
        "texture_weight", "stereo_weight", "stereo_weight_with_texture"}) {
    for (const std::string value : {"-0.1", "10.1", "much"}) {
      EXPECT_THAT([&] { LoadConfig<RefinerFile>("", {"refiner." + key + "=" + value}); },
                  ::testing::ThrowsMessage<ConfigError>(::testing::HasSubstr("refiner." + key)));
    }
    EXPECT_NO_THROW(LoadConfig<RefinerFile>("", {"refiner." + key + "=2"}));
  }
}

}  // namespace
}  // namespace visavis
