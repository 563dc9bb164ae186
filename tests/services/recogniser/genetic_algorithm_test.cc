#include "services/recogniser/genetic_algorithm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/services/recogniser/ga_settings.h"
#include "tests/support/malloc_counter.h"

namespace visavis {
namespace {

void Generation(GeneticAlgorithm* ga) {
  ga->Reproduce();
  ga->Evaluate(SmoothFitness);
}

TEST(GeneticAlgorithmTest, TheFirstPopulationIsUniformInTheSpace) {
  const GeneticAlgorithm ga(Inert(4000), ASpace(), 1);
  std::array<std::array<int, 4>, 6> quarters{};
  for (const Individual& individual : ga.population()) {
    ASSERT_TRUE(ASpace().Contains(individual.phi));
    EXPECT_FALSE(individual.evaluated);
    for (int k = 0; k < 6; ++k) {
      const double share = (individual.phi[k] - ASpace().min[k]) / ASpace().range()[k];
      ++quarters[k][std::min(3, static_cast<int>(4 * share))];
    }
  }
  for (const auto& parameter : quarters) {
    for (const int n : parameter) EXPECT_NEAR(n, 1000, 5 * std::sqrt(4000 * 0.25 * 0.75));
  }
}

TEST(GeneticAlgorithmTest, TheBestNeverGetsWorseFromGenerationToGeneration) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    GeneticAlgorithm ga(Working(), ASpace(), seed);
    ga.Evaluate(SmoothFitness);
    for (int i = 0; i < 30; ++i) {
      const double before = ga.best().fitness;
      Generation(&ga);
      EXPECT_GE(ga.best().fitness, before);
    }
  }
}

TEST(GeneticAlgorithmTest, TheEliteSurvivesUnchangedAndIsNotEvaluatedAgain) {
  GeneticAlgorithm ga(Working(), ASpace(), 2);
  EXPECT_EQ(ga.Evaluate(SmoothFitness), 60);
  const std::vector<Individual> before = ga.population();
  ga.Reproduce();
  for (std::size_t i = 0; i < 60; ++i) {
    EXPECT_EQ(ga.population()[i].evaluated, i < 15) << i;
    if (i < 15) {
      EXPECT_EQ(ga.population()[i].phi, before[i].phi) << i;
    }
  }
  EXPECT_EQ(ga.Evaluate(SmoothFitness), 45);
}

TEST(GeneticAlgorithmTest, NewImagesAskForTheWholePopulation) {
  GeneticAlgorithm ga(Working(), ASpace(), 3);
  EXPECT_EQ(ga.Evaluate(SmoothFitness), 60);
  EXPECT_EQ(ga.Evaluate(SmoothFitness), 0);
  ga.Invalidate();
  EXPECT_EQ(ga.Evaluate(SmoothFitness), 60);
}

TEST(GeneticAlgorithmTest, TheSameSeedGivesTheSamePopulationsAndAnotherSeedOthers) {
  GeneticAlgorithm a(Working(), ASpace(), 4), b(Working(), ASpace(), 4), c(Working(), ASpace(), 5);
  for (int i = 0; i < 20; ++i) {
    for (GeneticAlgorithm* ga : {&a, &b, &c}) {
      ga->Evaluate(SmoothFitness);
      ga->Reproduce();
    }
  }
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(a.population()[i].phi, b.population()[i].phi) << i;
  EXPECT_NE(a.population()[0].phi, c.population()[0].phi);
}

TEST(GeneticAlgorithmTest, EqualFitnessKeepsItsOrder) {
  GeneticAlgorithm ga(Inert(50), ASpace(), 6);
  std::vector<Vector6d> expected;
  for (const Individual& individual : ga.population()) expected.push_back(individual.phi);
  const auto class_of = [](const Vector6d& phi) { return std::floor(phi[0] * 20); };
  std::stable_sort(expected.begin(), expected.end(),
                   [&](const Vector6d& a, const Vector6d& b) { return class_of(a) > class_of(b); });
  ga.Evaluate(class_of);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(ga.population()[i].phi, expected[i]) << i;
}

// What feedforward asks for when the camera moves slowly.
Vector6d DriftATenthOfAStepFor100Frames(bool carry_remainder) {
  GaConfig config = Inert(20);
  config.elite_share = 0.25;
  config.tournament = 2;
  config.crossover_probability = 1;  // among equals it changes nothing
  config.carry_remainder = carry_remainder;
  GeneticAlgorithm ga(config, ASpace(), 12);
  const GeneCodec codec(ASpace(), 8);
  const Vector6d start = codec.Decode(codec.Encode(PhiOf(-100, -100, 1000, -10, -10, -10)));
  ga.Scatter(start, Vector6d::Zero());
  for (int frame = 0; frame < 100; ++frame) {
    ga.Move([&](Vector6d* phi) { *phi += 0.1 * codec.step(); });
    ga.Evaluate(SmoothFitness);
    ga.Reproduce();
  }
  return (ga.best().phi - start).cwiseQuotient(codec.step());
}

TEST(GeneticAlgorithmTest, ADriftOfATenthOfAStepAFrameSurvivesWithTheRemainderCarried) {
  const Vector6d steps = DriftATenthOfAStepFor100Frames(true);
  EXPECT_NEAR(steps.minCoeff(), 10, 1e-6);
  EXPECT_NEAR(steps.maxCoeff(), 10, 1e-6);
}

TEST(GeneticAlgorithmTest, ADriftOfATenthOfAStepAFrameIsLostWithoutTheRemainder) {
  EXPECT_NEAR(DriftATenthOfAStepFor100Frames(false).norm(), 0, 1e-6);
}

TEST(GeneticAlgorithmTest, WithoutTheRemainderEveryIndividualIsItsGene) {
  GaConfig config = Working();
  config.carry_remainder = false;
  GeneticAlgorithm ga(config, ASpace(), 13);
  const GeneCodec codec(ASpace(), 8);
  const auto expect_genes = [&](const char* after) {
    double farthest = 0;
    for (const Individual& individual : ga.population()) {
      farthest =
          std::max(farthest, (individual.phi - codec.Decode(codec.Encode(individual.phi))).norm());
    }
    EXPECT_LT(farthest, 1e-12) << after;
  };
  expect_genes("construction");
  ga.Evaluate(SmoothFitness);
  ga.Reproduce();
  expect_genes("reproduction");
  ga.Move([](Vector6d* phi) { *phi += PhiOf(1.234, 1.234, 1.234, 0.1, 0.1, 0.1); });
  expect_genes("feedforward");
  ga.Scatter(PhiOf(1, 2, 1003, 4, 5, 6), PhiOf(5, 5, 5, 1, 1, 1));
  expect_genes("scattering");
}

TEST(GeneticAlgorithmTest, ScatterIsNormalRoundThePoseWithTheGivenSpread) {
  GeneticAlgorithm ga(Inert(4000), ASpace(), 14);
  const Vector6d centre = PhiOf(20, -30, 1050, 2, -3, 4), spread = PhiOf(8, 7, 6, 3, 2, 1);
  ga.Scatter(centre, spread);
  Vector6d mean = Vector6d::Zero(), square = Vector6d::Zero();
  for (const Individual& individual : ga.population()) {
    mean += (individual.phi - centre) / 4000;
    square += (individual.phi - centre).cwiseAbs2() / 4000;
  }
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(mean[k] / spread[k], 0, 0.08) << k;
    EXPECT_NEAR(std::sqrt(square[k]) / spread[k], 1, 0.06) << k;
  }
}

TEST(GeneticAlgorithmTest, MovedIndividualsStayInTheSpace) {
  GeneticAlgorithm ga(Working(), ASpace(), 15);
  ga.Move([](Vector6d* phi) { (*phi)[0] += 0.3; });
  for (const Individual& individual : ga.population()) {
    EXPECT_TRUE(ASpace().Contains(individual.phi));
    EXPECT_FALSE(individual.evaluated);
  }
}

TEST(GeneticAlgorithmTest, ANewSpaceClampsWhoLiesOutsideAndAsksForTheirFitnessAnew) {
  GeneticAlgorithm ga(Inert(200), ASpace(), 16);
  ga.Evaluate(SmoothFitness);
  const std::vector<Individual> before = ga.population();
  const SearchSpace moved = ASpace().CentredOn({0.2, 0, 1.05});
  ga.SetSpace(moved);
  EXPECT_EQ(ga.space().min, moved.min);
  int kept = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    const bool was_inside = moved.Contains(before[i].phi);
    kept += was_inside;
    ASSERT_EQ(ga.population()[i].phi, moved.Clamp(before[i].phi));
    ASSERT_EQ(ga.population()[i].evaluated, was_inside);
  }
  EXPECT_GT(kept, 50);
  EXPECT_LT(kept, 150);
}

TEST(GeneticAlgorithmTest, ConvergesOnASmoothFunction) {
  std::vector<double> off;  // mean distance a parameter from the optimum, over the range
  for (std::uint64_t seed = 0; seed < 11; ++seed) {
    GeneticAlgorithm ga(Working(), ASpace(), seed);
    ga.Evaluate(SmoothFitness);
    for (int i = 0; i < 150; ++i) Generation(&ga);
    off.push_back(std::sqrt(-ga.best().fitness / 6));
  }
  std::sort(off.begin(), off.end());
  EXPECT_LT(off[5], 0.015);
  EXPECT_LT(off.back(), 0.04);
}

TEST(GeneticAlgorithmTest, BeatsRandomSearchWithAsManyEvaluations) {
  // Many local maxima round a global one.
  const auto fitness = [](const Vector6d& phi) {
    const Vector6d x = (phi - PhiOf(60, -80, 1010, 7, -3, 11)).cwiseQuotient(ASpace().range());
    return -x.squaredNorm() + 0.02 * (40 * x).array().cos().mean();
  };
  int wins = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    GeneticAlgorithm ga(Working(), ASpace(), seed);
    int evaluations = ga.Evaluate(fitness);
    for (int i = 0; i < 40; ++i) {
      ga.Reproduce();
      evaluations += ga.Evaluate(fitness);
    }
    Random random(1000 + seed);
    double best = -1;
    for (int i = 0; i < evaluations; ++i) {
      Vector6d phi;
      for (int k = 0; k < 6; ++k) phi[k] = random.Uniform(ASpace().min[k], ASpace().max[k]);
      best = std::max(best, fitness(phi));
    }
    wins += ga.best().fitness > best;
  }
  EXPECT_GE(wins, 19);
}

TEST(GeneticAlgorithmTest, AllocatesNothingAfterItsConstruction) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  GeneticAlgorithm ga(Working(), ASpace(), 17);
  const SearchSpace moved = ASpace().CentredOn({0.1, 0, 1});
  const std::int64_t before = NumMallocs();
  for (int i = 0; i < 5; ++i) {
    ga.Invalidate();
    ga.Move([](Vector6d* phi) { (*phi)[0] += 0.001; });
    Generation(&ga);
    ga.SetSpace(moved);
  }
  ga.Scatter(PhiOf(1, 2, 1003, 4, 5, 6), PhiOf(5, 5, 5, 1, 1, 1));
  ga.Restart();
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
