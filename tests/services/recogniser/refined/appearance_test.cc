#include "services/recogniser/refined/appearance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "common/core/random.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/naive_bands.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

const FacePoints& Face() { return SharedAdultHead().face; }

std::vector<unsigned char> All() { return std::vector<unsigned char>(Face().size(), 1); }

/// Samples as if every point were seen, of the given values.
FaceSamples SamplesOf(const std::vector<float>& values) {
  FaceSamples samples(values.size());
  samples.value = values;
  std::fill(samples.seen.begin(), samples.seen.end(), static_cast<unsigned char>(1));
  std::fill(samples.facing.begin(), samples.facing.end(), 1.0f);
  std::fill(samples.slope.begin(), samples.slope.end(), Vector3f::Zero());
  return samples;
}

std::vector<float> RandomPattern() {
  Random random(1);
  std::vector<float> pattern(Face().size());
  for (float& p : pattern) p = static_cast<float>(random.Normal());
  return pattern;
}

class AppearanceTest : public ::testing::Test {
 protected:
  AppearanceTest()
      : scene_(TestRig()),
        X_CM_(TransformFromPhi(PhiOf(20, -10, 1000, 4, -5, 3))),
        view_(scene_.Show(X_CM_, GrainyHead)) {}

  FaceSamples Sample(std::size_t eye, const RigidTransform& X_CM, Band band = kFineBand,
                     float min_facing = 0.3f) const {
    FaceSamples samples(Face().size());
    SampleFace(Face(), view_[eye], EyePose(*view_[eye].geometry, X_CM), band, min_facing, &samples);
    return samples;
  }

  PoseEquations StereoAt(const RigidTransform& X_CM, Band band) const {
    PoseEquations equations;
    AddStereo(Face(), Sample(0, X_CM, band), Sample(1, X_CM, band), X_CM.linear().cast<float>(),
              0.35f, 1, &equations);
    return equations;
  }

  MeshScene scene_;
  RigidTransform X_CM_;
  const StereoView& view_;
};

TEST_F(AppearanceTest, AValueIsTheBandsWhereThePointIsSeen) {
  const FaceSamples samples = Sample(1, X_CM_);
  int seen = 0;
  for (std::size_t i = 0; i < Face().size(); ++i) {
    if (!samples.seen[i]) continue;
    ++seen;
    const Projection at = ProjectLeft(TestRig(), X_CM_, Face().points[i].cast<double>());
    BandSample expected{};
    ASSERT_TRUE(SampleBand(view_[1].bands->view(kFineBand), static_cast<float>(at.uv.x()),
                           static_cast<float>(at.uv.y()), &expected));
    EXPECT_NEAR(samples.value[i], expected.value, 0.02f);
  }
  EXPECT_GT(seen, 300);
}

TEST_F(AppearanceTest, TheSlopeIsTheChangeOfValueWithThePointsPlaceInC) {
  const FaceSamples here = Sample(1, X_CM_);
  for (int k = 0; k < 3; ++k) {
    const double h = k == 2 ? 0.008 : 0.0015;  // about a sample of the band
    const RigidTransform ahead = Moved(X_CM_, h * Vector6d::Unit(k));
    const RigidTransform behind = Moved(X_CM_, -h * Vector6d::Unit(k));
    const FaceSamples more = Sample(1, ahead), less = Sample(1, behind);
    double product = 0, slopes = 0, differences = 0;
    for (std::size_t i = 0; i < Face().size(); ++i) {
      if (!here.seen[i] || !more.seen[i] || !less.seen[i]) continue;
      const auto slope = static_cast<double>(here.slope[i][k]);
      const double difference = static_cast<double>(more.value[i] - less.value[i]) / (2 * h);
      product += slope * difference;
      slopes += slope * slope;
      differences += difference * difference;
    }
    EXPECT_GT(product / std::sqrt(slopes * differences), 0.95) << k;
    EXPECT_NEAR(product / slopes, 1, 0.2) << k;
  }
}

TEST_F(AppearanceTest, PointsTurnedAsideAndPointsOutOfThePictureAreNotSeen) {
  for (const float min_facing : {0.3f, 0.6f, 0.9f}) {
    const FaceSamples samples = Sample(0, X_CM_, kFineBand, min_facing);
    const EyePose pose(*view_[0].geometry, X_CM_);
    for (std::size_t i = 0; i < Face().size(); ++i) {
      const Vector3f view = (Face().points[i] - pose.p_ME).normalized();
      const float facing = -Face().normals[i].dot(view);
      if (std::abs(facing - min_facing) < 1e-4f) continue;
      EXPECT_EQ(samples.seen[i] != 0, facing > min_facing);
      if (!samples.seen[i]) continue;
      EXPECT_NEAR(samples.facing[i], facing, 1e-4f);
    }
  }
  const FaceSamples outside = Sample(0, TransformFromPhi(PhiOf(900, 0, 1000, 0, 0, 0)));
  const FaceSamples behind = Sample(0, TransformFromPhi(PhiOf(0, 0, -1000, 0, 180, 0)));
  for (std::size_t i = 0; i < Face().size(); ++i) {
    EXPECT_FALSE(outside.seen[i]);
    EXPECT_FALSE(behind.seen[i]);
  }
}

TEST(FitPatternTest, RecoversGainAndOffset) {
  const std::vector<float> pattern = RandomPattern();
  std::vector<float> values;
  for (const float p : pattern) values.push_back(-2.5f * p + 7);
  const GainOffset fit = FitPattern(SamplesOf(values), pattern, All());
  EXPECT_EQ(fit.count, static_cast<int>(Face().size()));
  EXPECT_NEAR(fit.gain, -2.5, 1e-5);
  EXPECT_NEAR(fit.offset, 7, 1e-5);
  EXPECT_NEAR(fit.correlation, -1, 1e-6);
  EXPECT_NEAR(fit.pattern_rms, 1, 0.1);
}

TEST(FitPatternTest, NoiseLowersTheCorrelationAsItsShareOfTheVariance) {
  const std::vector<float> pattern = RandomPattern();
  Random random(2);
  std::vector<float> values;
  for (const float p : pattern) values.push_back(3 * p + 4 * static_cast<float>(random.Normal()));
  const GainOffset fit = FitPattern(SamplesOf(values), pattern, All());
  EXPECT_NEAR(fit.correlation, 0.6, 0.08);
  EXPECT_NEAR(fit.gain, 3, 0.6);
}

TEST(FitPatternTest, OnlyPointsSeenAndUsableCount) {
  const std::vector<float> pattern = RandomPattern();
  FaceSamples samples = SamplesOf(pattern);
  std::vector<unsigned char> usable = All();
  for (std::size_t i = 0; i < pattern.size(); i += 2) {
    samples.value[i] = 1000;
    (i % 4 == 0 ? samples.seen : usable)[i] = 0;
  }
  const GainOffset fit = FitPattern(samples, pattern, usable);
  EXPECT_EQ(fit.count, static_cast<int>(pattern.size() / 2));
  EXPECT_NEAR(fit.gain, 1, 1e-5);
  std::fill(usable.begin() + 79, usable.end(), static_cast<unsigned char>(0));  // 39 are left
  EXPECT_EQ(FitPattern(samples, pattern, usable).gain, 0);
  EXPECT_EQ(FitPattern(samples, pattern, usable).correlation, 0);
}

// What the true pose shows is the pattern; at a pose 2 mm aside it pulls back.
TEST_F(AppearanceTest, APatternPullsADisplacedHeadBack) {
  for (const Band band : {kFineBand, kCoarseBand}) {
    const FaceSamples truth = Sample(0, X_CM_, band);
    for (int k = 0; k < 2; ++k) {
      for (const double error : {-0.0015, 0.0015}) {
        const RigidTransform X = Moved(X_CM_, error * Vector6d::Unit(k));
        PoseEquations equations;
        const GainOffset fit = AddPattern(Face(), Sample(0, X, band), X.linear().cast<float>(),
                                          truth.value, truth.seen, 0.45f, 1, &equations);
        EXPECT_GT(fit.correlation, 0.5);
        const Eigen::Matrix2d H = equations.Full().topLeftCorner<2, 2>();
        const Eigen::Vector2d step = H.ldlt().solve(equations.g.head<2>());
        EXPECT_NEAR(step[k], -error, 0.35 * std::abs(error)) << band << k;
      }
    }
  }
}

TEST_F(AppearanceTest, AtTheTruePoseThePatternPullsNowhere) {
  const FaceSamples truth = Sample(0, X_CM_);
  PoseEquations equations;
  const GainOffset fit = AddPattern(Face(), truth, X_CM_.linear().cast<float>(), truth.value,
                                    truth.seen, 0.45f, 1, &equations);
  EXPECT_NEAR(fit.correlation, 1, 1e-5);
  EXPECT_LT(equations.g.norm(), 1e-3 * equations.H.norm());
}

TEST_F(AppearanceTest, ThePullDoesNotDependOnThePatternsUnits) {
  const FaceSamples truth = Sample(0, X_CM_);
  const RigidTransform X = Moved(X_CM_, 0.001 * Vector6d::Unit(0));
  const FaceSamples samples = Sample(0, X);
  std::vector<float> other;
  for (const float v : truth.value) other.push_back(0.02f * v - 3);
  PoseEquations a, b;
  const Eigen::Matrix3f R = X.linear().cast<float>();
  AddPattern(Face(), samples, R, truth.value, truth.seen, 0.45f, 1, &a);
  AddPattern(Face(), samples, R, other, truth.seen, 0.45f, 1, &b);
  EXPECT_LT((a.g - b.g).norm(), 1e-3 * a.g.norm());
}

TEST_F(AppearanceTest, APatternUpsideDownIsNeverFollowed) {
  const FaceSamples truth = Sample(0, X_CM_);
  std::vector<float> negative;
  for (const float v : truth.value) negative.push_back(-v);
  PoseEquations upright, inverted;
  const Eigen::Matrix3f R = X_CM_.linear().cast<float>();
  const GainOffset fit = AddPattern(Face(), truth, R, negative, truth.seen, 0.45f, 1, &inverted);
  AddPattern(Face(), truth, R, truth.value, truth.seen, 0.45f, 1, &upright);
  EXPECT_NEAR(fit.gain, -1, 1e-4);
  EXPECT_GT(inverted.g.norm(), 10 * upright.g.norm());  // it wants to be elsewhere
}

TEST_F(AppearanceTest, TooFewPointsAddNothing) {
  const FaceSamples truth = Sample(0, X_CM_);
  std::vector<unsigned char> few(Face().size());
  std::fill(few.begin(), few.begin() + 39, static_cast<unsigned char>(1));
  PoseEquations equations;
  AddPattern(Face(), truth, X_CM_.linear().cast<float>(), truth.value, few, 0.45f, 1, &equations);
  EXPECT_EQ(equations.H, Matrix6d::Zero());
  const FaceSamples none(Face().size());
  AddStereo(Face(), truth, none, X_CM_.linear().cast<float>(), 0.35f, 1, &equations);
  EXPECT_EQ(StereoCorrelation(truth, none, Face().size()), 0);
  EXPECT_EQ(equations.H, Matrix6d::Zero());
}

TEST_F(AppearanceTest, TheAgreementOfBothEyesCorrectsFiveMillimetresOfDepth) {
  for (const double error : {-0.005, 0.005}) {
    const PoseEquations equations = StereoAt(Moved(X_CM_, error * Vector6d::Unit(2)), kFineBand);
    EXPECT_NEAR(equations.g[2] / equations.H(2, 2), -error, 0.3 * std::abs(error));
  }
}

// A smooth face before a wall: what blurs into it at the outline is the wall, at another depth.
TEST_F(AppearanceTest, TheSurroundingsDoNotPullTheDepth) {
  for (const Vector6d& phi : {PhiOf(20, -10, 1000, 4, -5, 3), PhiOf(-20, 10, 1050, -4, 8, -3)}) {
    const RigidTransform X = TransformFromPhi(phi);
    scene_.Show(X, FeaturedHead);
    const PoseEquations equations = StereoAt(X, kFineBand);
    // 3 mm where all points count.
    EXPECT_LT(std::abs(equations.g[2] / equations.H(2, 2)), 0.001);
  }
}

TEST_F(AppearanceTest, EyesThatAgreeCorrelateAndAWrongDepthCorrelatesLess) {
  const auto correlation = [&](double z) {
    const RigidTransform X = Moved(X_CM_, z * Vector6d::Unit(2));
    return StereoCorrelation(Sample(0, X), Sample(1, X), Face().size());
  };
  EXPECT_GT(correlation(0), 0.8);
  EXPECT_LT(correlation(0.03), correlation(0) - 0.3);
}

TEST_F(AppearanceTest, TheEyesMayDifferInGainAndOffset) {
  const RigidTransform X = Moved(X_CM_, 0.005 * Vector6d::Unit(2));
  const FaceSamples right = Sample(0, X);
  FaceSamples left = Sample(1, X);
  for (std::size_t i = 0; i < Face().size(); ++i) {
    left.value[i] = 0.5f * left.value[i] + 9;
    left.slope[i] *= 0.5f;
  }
  PoseEquations equations;
  AddStereo(Face(), right, left, X.linear().cast<float>(), 0.35f, 1, &equations);
  EXPECT_NEAR(equations.g[2] / equations.H(2, 2), -0.005, 0.0015);
}

}  // namespace
}  // namespace visavis
