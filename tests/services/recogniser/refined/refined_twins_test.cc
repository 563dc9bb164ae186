// The refined estimator's kernels beside their naive double-precision twins, and on every SIMD
// target.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/recogniser/fitness_kernel.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/naive_bands.h"
#include "tests/support/naive_refined.h"
#include "tests/support/simd_targets.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

class RefinedTwinsTest : public ::testing::Test {
 protected:
  RefinedTwinsTest()
      : scene_(TestRig()), view_(scene_.Show(TransformFromPhi(kTruth), GrainyHead)), random_(1) {}
  ~RefinedTwinsTest() override { SelectSimdTarget("auto"); }

  /// Up to a few cm and 0.1 rad beside the truth.
  RigidTransform NearTruth() {
    Vector6d phi = kTruth;
    for (int k = 0; k < 6; ++k) phi[k] += (k < 3 ? 0.015 : 0.1) * random_.Normal();
    return TransformFromPhi(phi);
  }

  const Vector6d kTruth = PhiOf(20, -10, 1000, 4, -5, 3);
  const SharedHead& head_ = SharedAdultHead();
  MeshScene scene_;
  const StereoView& view_;
  Random random_;
};

TEST_F(RefinedTwinsTest, TheFitnessEqualsItsTwin) {
  for (const int detail : {1, 2}) {
    const MeshFitness fitness(head_.mesh, head_.face, detail);
    const NaiveMeshFitness naive(head_.mesh, head_.face, detail);
    for (int i = 0; i < 20; ++i) {
      const RigidTransform X_CM = NearTruth();
      const MeshScore a = fitness.Evaluate(view_, X_CM), b = naive.Evaluate(view_, X_CM);
      // A point between two pixels may fall to either.
      EXPECT_NEAR(a.inside, b.inside, 0.01);
      EXPECT_NEAR(a.outside, b.outside, 0.02);
      EXPECT_NEAR(a.ncc, b.ncc, 0.01);
    }
  }
}

TEST_F(RefinedTwinsTest, TheBandsEqualTheirTwins) {
  const NaiveBands naive(scene_.picture(0));
  for (const Band band : {kFineBand, kCoarseBand, kBrightness}) {
    const BandView view = view_[0].bands->view(band);
    ASSERT_EQ(naive.bands[band].size(), static_cast<std::size_t>(view.width * view.height));
    for (std::size_t i = 0; i < naive.bands[band].size(); ++i) {
      const auto value = static_cast<std::int16_t>(view.pairs[i] & 0xffff);
      ASSERT_NEAR(static_cast<double>(value) / kBandSteps, naive.bands[band][i], 0.1) << i;
    }
  }
}

TEST_F(RefinedTwinsTest, TheNormalEquationsEqualTheirTwins) {
  PoseRefiner refiner({}, head_.surface, head_.mesh, head_.face);
  const NaiveRefiner naive({}, head_.surface, head_.mesh, head_.face);
  for (int i = 0; i < 10; ++i) {
    const RigidTransform X_CM = NearTruth();
    const PoseEquations a = refiner.Generic(view_, X_CM), b = naive.Generic(view_, X_CM);
    EXPECT_LT((a.H - b.H).norm(), 0.003 * b.H.norm()) << i;
    // What matters is the step; in units of its own uncertainty.
    const Vector6d step = a.H.ldlt().solve(a.g) - b.H.ldlt().solve(b.g);
    EXPECT_LT(std::sqrt(step.dot(b.H * step)), 0.3) << i;
  }
}

TEST_F(RefinedTwinsTest, EverySimdTargetGivesTheSameBits) {
  const MeshFitness fitness(head_.mesh, head_.face, 1);
  PoseRefiner refiner({}, head_.surface, head_.mesh, head_.face);
  for (int i = 0; i < 5; ++i) {
    const RigidTransform X_CM = NearTruth();
    SelectSimdTarget("auto");
    scene_.Show(TransformFromPhi(kTruth), GrainyHead);
    const MeshScore score = fitness.Evaluate(view_, X_CM);
    const double found = fitness.FoundIfWorth(view_, X_CM, 0);
    const Refined refined = refiner.Refine(view_, X_CM, nullptr, 4, 9);
    for (const std::string& target : ListSimdTargets()) {
      SelectSimdTarget(target.c_str());
      scene_.Show(TransformFromPhi(kTruth), GrainyHead);
      const MeshScore other = fitness.Evaluate(view_, X_CM);
      EXPECT_EQ(other.inside, score.inside) << target;
      EXPECT_EQ(other.outside, score.outside) << target;
      EXPECT_EQ(other.ncc, score.ncc) << target;
      EXPECT_EQ(fitness.FoundIfWorth(view_, X_CM, 0), found) << target;
      const Refined again = refiner.Refine(view_, X_CM, nullptr, 4, 9);
      EXPECT_EQ(again.X_CM.matrix(), refined.X_CM.matrix()) << target;
      EXPECT_EQ(again.information, refined.information) << target;
      EXPECT_EQ(again.contour.sum_square, refined.contour.sum_square) << target;
      EXPECT_EQ(again.stereo_ncc, refined.stereo_ncc) << target;
      EXPECT_EQ(again.likeness, refined.likeness) << target;
    }
  }
}

// Read beyond the maps' memory is what a sanitizer sees; here, that nothing is found there.
TEST_F(RefinedTwinsTest, APoseOutOfSightOrNowhereSaysNothing) {
  const MeshFitness fitness(head_.mesh, head_.face, 1);
  PoseRefiner refiner({}, head_.surface, head_.mesh, head_.face);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::string& target : ListSimdTargets()) {
    SelectSimdTarget(target.c_str());
    for (const double far : {3.0, -3.0, 1e9, -1e30, infinity, std::nan("")}) {
      for (const Eigen::Vector3d& p :
           {Eigen::Vector3d(far, 0, 1), Eigen::Vector3d(0, far, 1), Eigen::Vector3d(far, far, 0)}) {
        const RigidTransform X_CM = MakeTransform(Eigen::Matrix3d::Identity(), p);
        const MeshScore score = fitness.Evaluate(view_, X_CM);
        EXPECT_EQ(score.inside, 0) << target << p.transpose();
        EXPECT_EQ(score.outside, 0) << target << p.transpose();
        EXPECT_EQ(score.ncc, 0) << target << p.transpose();
        const PoseEquations equations = refiner.Generic(view_, X_CM);
        if (std::isfinite(far)) {
          EXPECT_EQ(equations.H, Matrix6d::Zero()) << p.transpose();
        }
      }
    }
  }
}

}  // namespace
}  // namespace visavis
