#include "services/arm_state/velocity_estimator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"

namespace visavis {
namespace {

JointVector Joint(double q) { return JointVector::Constant(1, q); }
double Slope(VelocityEstimator* estimator, std::int64_t utime_us, double q) {
  const auto slope = estimator->Add(utime_us, Joint(q));
  EXPECT_TRUE(slope.has_value());
  return slope ? (*slope)[0] : std::nan("");
}

TEST(VelocityEstimatorTest, OneReadingHasNoVelocityAndTwoHaveTheirSlope) {
  VelocityEstimator estimator(0.04);
  EXPECT_FALSE(estimator.Add(1'000'000, Joint(0.5)).has_value());
  EXPECT_NEAR(Slope(&estimator, 1'010'000, 0.6), 10, 1e-9);
  estimator.Reset();
  EXPECT_FALSE(estimator.Add(1'020'000, Joint(0.7)).has_value());
}

// At any rate, and with stamps that come unevenly.
TEST(VelocityEstimatorTest, IsExactForConstantAcceleration) {
  Random random(1);
  for (const double dt_s : {0.0005, 0.001, 0.005, 0.03, 0.2}) {
    VelocityEstimator estimator(0.04);
    double t_s = 0;
    for (int i = 0; i < 150; ++i) {
      t_s += 1e-6 * std::round(1e6 * dt_s * random.Uniform(0.5, 1.5));
      const double q = 0.3 - 1.2 * t_s + 2.5 * t_s * t_s;
      const auto slope = estimator.Add(std::llround(1e6 * t_s), Joint(q));
      if (i < 2) continue;
      EXPECT_NEAR((*slope)[0], -1.2 + 5 * t_s, 1e-6 * (1 + t_s)) << dt_s << " " << i;
    }
  }
}

// sigma_v = sigma_q / dt sqrt(192 / n^3) for a parabola's slope at its end, with n = 9 readings in
// 40 ms at 200 Hz (the formula is for many: a fifth more here).
TEST(VelocityEstimatorTest, NoiseIsAveragedOverTheWindow) {
  Random random(2);
  VelocityEstimator estimator(0.04);
  double sum = 0;
  const int n = 20'000;
  for (int i = 0; i < n + 10; ++i) {
    const auto slope = estimator.Add(5000 * i, Joint(1e-4 * random.Normal()));
    if (i >= 10) sum += (*slope)[0] * (*slope)[0];
  }
  const double expected = 1e-4 / 0.005 * std::sqrt(192.0 / (9 * 9 * 9));
  EXPECT_NEAR(std::sqrt(sum / n), expected, 0.25 * expected);
}

TEST(VelocityEstimatorTest, AWiderWindowIsQuieter) {
  const auto noise = [](double window_s) {
    Random random(3);
    VelocityEstimator estimator(window_s);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto slope = estimator.Add(1000 * i, Joint(1e-4 * random.Normal()));
      if (i >= 100) sum += (*slope)[0] * (*slope)[0];
    }
    return std::sqrt(sum);
  };
  EXPECT_LT(noise(0.04), 0.2 * noise(0.01));
}

TEST(VelocityEstimatorTest, JointsDoNotMix) {
  VelocityEstimator estimator(0.04);
  JointVector q(3), slope(3);
  slope << 1, -2, 0.5;
  for (int i = 0; i < 20; ++i) {
    q = 0.001 * i * slope;
    const auto found = estimator.Add(1000 * i, q);
    if (i < 2) continue;
    EXPECT_LT((*found - slope).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace visavis
