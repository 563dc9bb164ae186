#include "services/recogniser/refined/shape_equations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kLevel = 3;  // 642 vertices
constexpr ShapeEquations::Prior kPrior{0.010, 0.0008};

Vector3f RandomDirection(Random* random) {
  const auto normal = [&] { return static_cast<float>(random->Normal()); };
  return Vector3f(normal(), normal(), normal()).normalized();
}

/// A smooth bump of a few millimetres.
float Bump(const Vector3f& d) {
  return 0.003f * std::sin(2 * d.x() + 0.5f) + 0.002f * d.y() * d.z();
}

class ShapeEquationsTest : public ::testing::Test {
 protected:
  /// Measures @p movement in @p count random directions with random slopes, where @p measured.
  template <typename Movement, typename Where>
  void Measure(int count, double sigma, const Movement& movement, const Where& measured) {
    Random random(5);
    for (int i = 0; i < count; ++i) {
      const Vector3f d = RandomDirection(&random);
      const double slope = 1000 * random.Normal();
      if (!measured(d)) continue;
      equations_.Add(d, slope, slope * static_cast<double>(movement(d)), 1 / (sigma * sigma));
    }
  }
  static bool Everywhere(const Vector3f&) { return true; }
  const std::vector<Vector3f>& directions() const { return equations_.sphere().vertices(); }

  ShapeEquations equations_{kLevel};
  const std::vector<float> undisplaced_ =
      std::vector<float>(equations_.sphere().vertices().size(), 0.0f);
};

TEST_F(ShapeEquationsTest, ASmoothDisplacementIsRecoveredFromMeasurements) {
  Measure(5000, 0.01, Bump, Everywhere);
  const std::vector<float> movement = equations_.Solve(undisplaced_, kPrior);
  ASSERT_EQ(movement.size(), directions().size());
  for (std::size_t i = 0; i < movement.size(); ++i) {
    EXPECT_NEAR(movement[i], Bump(directions()[i]), 1e-4) << directions()[i].transpose();
  }
}

TEST_F(ShapeEquationsTest, WithoutDataTheSurfaceStays) {
  for (const float m : equations_.Solve(undisplaced_, kPrior)) EXPECT_EQ(m, 0);
}

TEST_F(ShapeEquationsTest, WithoutDataWhatIsDisplacedGoesBackAllTheWay) {
  std::vector<float> displaced;
  for (const Vector3f& d : directions()) displaced.push_back(Bump(d));
  const std::vector<float> movement = equations_.Solve(displaced, kPrior);
  for (std::size_t i = 0; i < movement.size(); ++i) EXPECT_NEAR(movement[i], -displaced[i], 1e-7);
}

TEST_F(ShapeEquationsTest, WeakDataLeaveTheSurfaceBetweenThePriorAndThemselves) {
  const auto still = [](const Vector3f&) { return 0.0f; };
  Measure(300, 20, still, Everywhere);
  const std::vector<float> displaced(undisplaced_.size(), 0.004f);
  double sum = 0;
  for (const float m : equations_.Solve(displaced, kPrior)) sum += static_cast<double>(m);
  const double mean = sum / static_cast<double>(displaced.size());
  EXPECT_LT(mean, -0.0002);
  EXPECT_GT(mean, -0.0038);
}

TEST_F(ShapeEquationsTest, AHoleInTheDataIsFilledAsItsBorderIs) {
  const auto raised = [](const Vector3f&) { return 0.003f; };
  Measure(5000, 0.01, raised, [](const Vector3f& d) { return d.z() < 0.9f; });
  const ShapeEquations::Prior smooth{1, 0.0008};  // wherever the surface lies, it is smooth
  for (const float m : equations_.Solve(undisplaced_, smooth)) EXPECT_NEAR(m, 0.003, 1e-6);
}

TEST_F(ShapeEquationsTest, ContradictingMeasurementsAreAveragedByWeight) {
  const Vector3f d = directions()[7];
  equations_.Add(d, 1, 0.001, 1e12);
  equations_.Add(d, 1, 0.005, 3e12);
  EXPECT_NEAR(equations_.Solve(undisplaced_, {1, 1})[7], 0.004, 1e-6);
}

// The movement m minimises
//   sum weight (slope m(d) - residual)^2 + |L (b + m)|^2 / roughness^2 + |b + m|^2 / displacement^2
// with b as displaced before, L b: a vertex less the mean of its neighbours.
TEST_F(ShapeEquationsTest, TheMovementMinimisesWhatItIsSaidTo) {
  struct Measured {
    Vector3f d;
    double slope, residual, weight;
  };
  Random random(3);
  std::vector<Measured> all;
  for (int i = 0; i < 200; ++i) {
    all.push_back({RandomDirection(&random), 1000 * random.Normal(), random.Normal(),
                   0.5 + random.Uniform()});
    equations_.Add(all.back().d, all.back().slope, all.back().residual, all.back().weight);
  }
  std::vector<float> before;
  for (const Vector3f& d : directions()) before.push_back(Bump(d));
  std::vector<std::vector<std::size_t>> neighbours(before.size());
  for (const auto& t : equations_.sphere().triangles()) {
    for (std::size_t k = 0; k < 3; ++k)
      neighbours[static_cast<std::size_t>(t[k])].push_back(
          static_cast<std::size_t>(t[(k + 1) % 3]));
  }
  const auto cost = [&](const std::vector<float>& movement) {
    double sum = 0;
    for (const Measured& m : all) {
      const auto place = equations_.sphere().Locate(m.d);
      double moved = 0;
      for (int k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(place.corners[static_cast<std::size_t>(k)]);
        moved += static_cast<double>(place.weights[k] * movement[corner]);
      }
      sum += m.weight * std::pow(m.slope * moved - m.residual, 2);
    }
    const auto at = [&](std::size_t v) { return static_cast<double>(before[v] + movement[v]); };
    for (std::size_t v = 0; v < before.size(); ++v) {
      double mean = 0;
      for (const std::size_t w : neighbours[v])
        mean += at(w) / static_cast<double>(neighbours[v].size());
      sum += std::pow((at(v) - mean) / kPrior.roughness_m, 2) +
             std::pow(at(v) / kPrior.displacement_m, 2);
    }
    return sum;
  };
  const std::vector<float> best = equations_.Solve(before, kPrior);
  const double least = cost(best);
  EXPECT_LT(least, 0.9 * cost(undisplaced_));
  for (int k = 0; k < 20; ++k) {
    std::vector<float> other = best;
    for (float& m : other) m += static_cast<float>(1e-6 * random.Normal());
    EXPECT_GT(cost(other), least);
  }
}

TEST_F(ShapeEquationsTest, ClearForgetsWhatWasMeasured) {
  Measure(500, 0.01, Bump, Everywhere);
  equations_.Clear();
  for (const float m : equations_.Solve(undisplaced_, kPrior)) EXPECT_EQ(m, 0);
}

TEST_F(ShapeEquationsTest, ADisplacementOfAnotherLevelIsRefused) {
  for (const std::size_t size : {0, 162, 641, 643}) {
    EXPECT_THROW(equations_.Solve(std::vector<float>(size, 0.0f), kPrior), std::invalid_argument);
  }
}

}  // namespace
}  // namespace visavis
