#include "services/recogniser/refined/shape_equations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kLevel = 3;  // 642 vertices
constexpr double kDisplacement_m = 0.010, kRoughness_m = 0.0008;

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
  const ShapeEquations::Prior prior_ = equations_.UniformPrior(kDisplacement_m, kRoughness_m);
};

TEST_F(ShapeEquationsTest, ASmoothDisplacementIsRecoveredFromMeasurements) {
  Measure(5000, 0.01, Bump, Everywhere);
  const std::vector<float> movement = equations_.Solve(undisplaced_, prior_);
  ASSERT_EQ(movement.size(), directions().size());
  for (std::size_t i = 0; i < movement.size(); ++i) {
    EXPECT_NEAR(movement[i], Bump(directions()[i]), 1e-4) << directions()[i].transpose();
  }
}

TEST_F(ShapeEquationsTest, WithoutDataTheSurfaceStays) {
  for (const float m : equations_.Solve(undisplaced_, prior_)) EXPECT_EQ(m, 0);
}

TEST_F(ShapeEquationsTest, WithoutDataWhatIsDisplacedGoesBackAllTheWay) {
  std::vector<float> displaced;
  for (const Vector3f& d : directions()) displaced.push_back(Bump(d));
  const std::vector<float> movement = equations_.Solve(displaced, prior_);
  for (std::size_t i = 0; i < movement.size(); ++i) EXPECT_NEAR(movement[i], -displaced[i], 1e-7);
}

TEST_F(ShapeEquationsTest, WeakDataLeaveTheSurfaceBetweenThePriorAndThemselves) {
  const auto still = [](const Vector3f&) { return 0.0f; };
  Measure(300, 20, still, Everywhere);
  const std::vector<float> displaced(undisplaced_.size(), 0.004f);
  double sum = 0;
  for (const float m : equations_.Solve(displaced, prior_)) sum += static_cast<double>(m);
  const double mean = sum / static_cast<double>(displaced.size());
  EXPECT_LT(mean, -0.0002);
  EXPECT_GT(mean, -0.0038);
}

TEST_F(ShapeEquationsTest, AHoleInTheDataIsFilledAsItsBorderIs) {
  const auto raised = [](const Vector3f&) { return 0.003f; };
  Measure(5000, 0.01, raised, [](const Vector3f& d) { return d.z() < 0.9f; });
  const ShapeEquations::Prior smooth =
      equations_.UniformPrior(1, 0.0008);  // wherever the surface lies, it is smooth
  for (const float m : equations_.Solve(undisplaced_, smooth)) EXPECT_NEAR(m, 0.003, 1e-6);
}

TEST_F(ShapeEquationsTest, ContradictingMeasurementsAreAveragedByWeight) {
  const Vector3f d = directions()[7];
  equations_.Add(d, 1, 0.001, 1e12);
  equations_.Add(d, 1, 0.005, 3e12);
  EXPECT_NEAR(equations_.Solve(undisplaced_, equations_.UniformPrior(1, 1))[7], 0.004, 1e-6);
}

// The movement m minimises, with some c,
//   sum weight (slope m(d) - residual)^2 + |L e|^2 / roughness^2 + |e|^2 / displacement^2 + |c|^2,
//   e = b + m - modes c,
// with b as displaced before, L e: a vertex less the mean of its neighbours.
class ShapeMinimumTest : public ShapeEquationsTest {
 protected:
  ShapeMinimumTest() {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
      all_.push_back({RandomDirection(&random), 1000 * random.Normal(), random.Normal(),
                      0.5 + random.Uniform()});
      equations_.Add(all_.back().d, all_.back().slope, all_.back().residual, all_.back().weight);
    }
    for (const Vector3f& d : directions()) before_.push_back(Bump(d));
    neighbours_.resize(before_.size());
    for (const auto& t : equations_.sphere().triangles()) {
      for (std::size_t k = 0; k < 3; ++k)
        neighbours_[static_cast<std::size_t>(t[k])].push_back(
            static_cast<std::size_t>(t[(k + 1) % 3]));
    }
  }

  double Cost(const std::vector<float>& movement, const Eigen::VectorXd& c,
              const ShapeEquations::Prior& prior) const {
    double sum = c.squaredNorm();
    for (const Measured& m : all_) {
      const auto place = equations_.sphere().Locate(m.d);
      double moved = 0;
      for (int k = 0; k < 3; ++k) {
        const auto corner = static_cast<std::size_t>(place.corners[static_cast<std::size_t>(k)]);
        moved += static_cast<double>(place.weights[k] * movement[corner]);
      }
      sum += m.weight * std::pow(m.slope * moved - m.residual, 2);
    }
    const Eigen::VectorXd explained = prior.modes_m * c;
    const auto at = [&](std::size_t v) {
      return static_cast<double>(before_[v] + movement[v]) -
             (c.size() > 0 ? explained[static_cast<Eigen::Index>(v)] : 0.0);
    };
    for (std::size_t v = 0; v < before_.size(); ++v) {
      double mean = 0;
      for (const std::size_t w : neighbours_[v])
        mean += at(w) / static_cast<double>(neighbours_[v].size());
      const auto i = static_cast<Eigen::Index>(v);
      sum += std::pow((at(v) - mean) / prior.roughness_m[i], 2) +
             std::pow(at(v) / prior.displacement_m[i], 2);
    }
    return sum;
  }

  struct Measured {
    Vector3f d;
    double slope, residual, weight;
  };
  std::vector<Measured> all_;
  std::vector<float> before_;
  std::vector<std::vector<std::size_t>> neighbours_;
};

TEST_F(ShapeMinimumTest, TheMovementMinimisesWhatItIsSaidTo) {
  const std::vector<float> best = equations_.Solve(before_, prior_);
  const Eigen::VectorXd none;
  const double least = Cost(best, none, prior_);
  EXPECT_LT(least, 0.9 * Cost(undisplaced_, none, prior_));
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    std::vector<float> other = best;
    for (float& m : other) m += static_cast<float>(1e-6 * random.Normal());
    EXPECT_GT(Cost(other, none, prior_), least);
  }
}

TEST_F(ShapeMinimumTest, WithModesAndAPriorByVertexToo) {
  ShapeEquations::Prior prior = prior_;
  prior.modes_m = Eigen::MatrixXd(before_.size(), 2);
  for (std::size_t v = 0; v < before_.size(); ++v) {
    const Vector3f& d = directions()[v];
    const auto i = static_cast<Eigen::Index>(v);
    prior.modes_m.row(i) << 0.004 * static_cast<double>(d.y()), 0.003 * std::cos(3.0f * d.z());
    if (d.x() > 0) prior.displacement_m[i] = 0.002;
    if (d.y() > 0) prior.roughness_m[i] = 0.0003;
  }
  const std::vector<float> best = equations_.Solve(before_, prior);
  // The coefficients that go with it: Cost is quadratic in them.
  const auto cost_of = [&](double c0, double c1) {
    return Cost(best, Eigen::Vector2d(c0, c1), prior);
  };
  const double f = cost_of(0, 0);
  Eigen::Matrix2d H;
  H(0, 0) = cost_of(1, 0) + cost_of(-1, 0) - 2 * f;
  H(1, 1) = cost_of(0, 1) + cost_of(0, -1) - 2 * f;
  H(0, 1) = H(1, 0) = (cost_of(1, 1) + cost_of(-1, -1) - cost_of(1, -1) - cost_of(-1, 1)) / 4;
  const Eigen::Vector2d g((cost_of(1, 0) - cost_of(-1, 0)) / 2,
                          (cost_of(0, 1) - cost_of(0, -1)) / 2);
  const Eigen::Vector2d c = -H.inverse() * g;
  EXPECT_GT(c.norm(), 0.1);
  const double least = Cost(best, c, prior);
  Random random(4);
  for (int k = 0; k < 20; ++k) {
    std::vector<float> other = best;
    for (float& m : other) m += static_cast<float>(3e-6 * random.Normal());
    const Eigen::Vector2d other_c = c + 0.003 * Eigen::Vector2d(random.Normal(), random.Normal());
    EXPECT_GT(Cost(other, other_c, prior), least);
  }
}

TEST_F(ShapeEquationsTest, WhereNothingIsMeasuredAModeCarriesOn) {
  ShapeEquations::Prior prior = equations_.UniformPrior(0.001, 0.0002);
  prior.modes_m = Eigen::MatrixXd(undisplaced_.size(), 1);
  for (std::size_t v = 0; v < undisplaced_.size(); ++v)
    prior.modes_m(static_cast<Eigen::Index>(v), 0) =
        0.003 * static_cast<double>(directions()[v].y());
  const auto twice = [](const Vector3f& d) { return 0.006f * d.y(); };
  Measure(3000, 0.05, twice, [](const Vector3f& d) { return d.x() > 0; });
  const std::vector<float> movement = equations_.Solve(undisplaced_, prior);
  for (std::size_t i = 0; i < movement.size(); ++i)
    EXPECT_NEAR(movement[i], twice(directions()[i]), 2e-4) << directions()[i].transpose();
}

TEST_F(ShapeEquationsTest, ClearForgetsWhatWasMeasured) {
  Measure(500, 0.01, Bump, Everywhere);
  equations_.Clear();
  for (const float m : equations_.Solve(undisplaced_, prior_)) EXPECT_EQ(m, 0);
}

TEST_F(ShapeEquationsTest, ADisplacementOfAnotherLevelIsRefused) {
  for (const std::size_t size : {0, 162, 641, 643}) {
    EXPECT_THROW(equations_.Solve(std::vector<float>(size, 0.0f), prior_), std::invalid_argument);
  }
}

}  // namespace
}  // namespace visavis
