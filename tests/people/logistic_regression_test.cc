#include "tests/people/logistic_regression.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace visavis {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRidge = 1e-3;

struct Samples {
  MatrixXd features;
  VectorXd truths;
};

/// Of a constant and two features from -1 to 1, true as often as the coefficients say.
Samples Draw(const Vector3d& coefficients, int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> feature(-1, 1), chance(0, 1);
  Samples samples{MatrixXd::Ones(count, 3), VectorXd(count)};
  for (int i = 0; i < count; ++i) {
    samples.features(i, 1) = feature(random);
    samples.features(i, 2) = feature(random);
    const double log_odds = samples.features.row(i) * coefficients;
    samples.truths[i] = chance(random) < 1 / (1 + std::exp(-log_odds));
  }
  return samples;
}

TEST(LogisticRegressionTest, RecoversTheCoefficientsThatSamplesWereDrawnBy) {
  const Vector3d expected(-1.5, 4, -2.5);
  const Samples samples = Draw(expected, 100000);
  const VectorXd found = LogisticRegression(samples.features, samples.truths, kRidge);
  ASSERT_EQ(found.size(), 3);
  // Its standard deviation is below 0.03.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 0.1) << k;
}

TEST(LogisticRegressionTest, IsWhereTheGradientOfTheLikelihoodVanishes) {
  constexpr double kStrong = 2.5;
  const Samples samples = Draw({0.3, 2, -6}, 500);
  const VectorXd found = LogisticRegression(samples.features, samples.truths, kStrong);
  VectorXd gradient = -kStrong * found;
  for (int i = 0; i < samples.truths.size(); ++i) {
    const double log_odds = samples.features.row(i) * found;
    gradient +=
        (samples.truths[i] - 1 / (1 + std::exp(-log_odds))) * samples.features.row(i).transpose();
  }
  EXPECT_LT(gradient.norm(), 1e-8);
}

// Without a ridge the coefficients would grow without end.
TEST(LogisticRegressionTest, StaysFiniteWhereAPlanePartsTheSamples) {
  Samples samples = Draw({0, 1, 1}, 400);
  for (int i = 0; i < samples.truths.size(); ++i) {
    double& feature = samples.features(i, 1);
    samples.truths[i] = feature > 0.2;
    feature += feature > 0.2 ? 0.1 : -0.1;
  }
  const VectorXd found = LogisticRegression(samples.features, samples.truths, kRidge);
  ASSERT_TRUE(found.allFinite());
  for (int i = 0; i < samples.truths.size(); ++i) {
    const double log_odds = samples.features.row(i) * found;
    EXPECT_EQ(log_odds > 0, samples.truths[i] == 1) << i;
  }
}

TEST(LogisticRegressionTest, RefusesWhatItCannotFit) {
  const MatrixXd two = MatrixXd::Ones(2, 1);
  EXPECT_THROW(LogisticRegression(two, VectorXd::Ones(3), kRidge), std::invalid_argument);
  EXPECT_THROW(LogisticRegression(two, VectorXd::Constant(2, 0.5), kRidge), std::invalid_argument);
  EXPECT_THROW(LogisticRegression(two / 0.0, VectorXd::Ones(2), kRidge), std::invalid_argument);
  EXPECT_THROW(LogisticRegression(two, VectorXd::Ones(2), 0), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
