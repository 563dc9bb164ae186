#include "services/recogniser/refined/real_population.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/support/malloc_counter.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

RealGaConfig TestGa() {
  RealGaConfig config;
  config.individuals = 40;
  config.elite_share = 0.2;
  config.tournament = 3;
  config.immigrant_share = 0.1;
  config.mutation_probability = 0.35;
  return config;
}

SearchSpace TestSpace() {
  SearchSpace space;
  space.min = PhiOf(-200, -150, 900, -20, -20, -20);
  space.max = PhiOf(200, 150, 1200, 20, 20, 20);
  return space;
}

const Vector6d kGoal = PhiOf(60, -40, 1010, 5, -7, 3);

/// 0 at the goal, less elsewhere: the squared distance in ranges.
double Sphere(const Vector6d& phi) {
  return -(phi - kGoal).cwiseQuotient(TestSpace().range()).squaredNorm();
}

double ShotSphere(const Vector6d& phi, double /*worth*/) { return Sphere(phi); }

RealPopulation APopulation(std::uint64_t seed = 1) {
  RealPopulation population(TestGa(), seed);
  population.SetSpace(TestSpace());
  population.Restart();
  return population;
}

bool IsSorted(const RealPopulation& population) {
  return std::is_sorted(
      population.individuals().begin(), population.individuals().end(),
      [](const Individual& a, const Individual& b) { return a.fitness > b.fitness; });
}

void ExpectWithinSpace(const RealPopulation& population) {
  for (const Individual& individual : population.individuals()) {
    EXPECT_TRUE(population.space().Contains(individual.phi)) << individual.phi.transpose();
  }
}

TEST(RealPopulationTest, RestartSpreadsAllOverTheSpace) {
  const RealPopulation population = APopulation();
  ASSERT_EQ(population.individuals().size(), 40u);
  ExpectWithinSpace(population);
  for (int k = 0; k < 6; ++k) {
    std::set<int> quarters;
    for (const Individual& individual : population.individuals()) {
      EXPECT_FALSE(individual.evaluated);
      quarters.insert(
          static_cast<int>(4 * (individual.phi[k] - TestSpace().min[k]) / TestSpace().range()[k]));
    }
    EXPECT_EQ(quarters.size(), 4u) << k;
  }
}

TEST(RealPopulationTest, EvaluateSortsAndCallsOnceAnIndividual) {
  RealPopulation population = APopulation();
  int calls = 0;
  EXPECT_EQ(population.Evaluate([&](const Vector6d& phi) {
    ++calls;
    return Sphere(phi);
  }),
            40);
  EXPECT_EQ(calls, 40);
  EXPECT_TRUE(IsSorted(population));
  for (const Individual& individual : population.individuals()) {
    EXPECT_TRUE(individual.evaluated);
    EXPECT_EQ(individual.fitness, Sphere(individual.phi));
  }
  EXPECT_EQ(population.best().fitness, population.individuals().front().fitness);
}

TEST(RealPopulationTest, StaysSortedFullAndWithinTheSpaceWhateverIsCalled) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  for (int i = 0; i < 10; ++i) {
    population.Reproduce(Sphere);
    EXPECT_TRUE(IsSorted(population));
    population.Insert(kGoal, Sphere(kGoal) - 0.02);
    EXPECT_TRUE(IsSorted(population));
    ExpectWithinSpace(population);
    ASSERT_EQ(population.individuals().size(), 40u);
  }
}

TEST(RealPopulationTest, FitnessBelongsToThePoseAfterEachCall) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  for (const Individual& shot : population.Shoot(100, ShotSphere)) {
    EXPECT_EQ(shot.fitness, Sphere(shot.phi));
    population.Insert(shot.phi, shot.fitness);
  }
  for (int i = 0; i < 5; ++i) population.Reproduce(Sphere);
  for (const Individual& individual : population.individuals()) {
    EXPECT_EQ(individual.fitness, Sphere(individual.phi));
  }
}

TEST(RealPopulationTest, InsertKeepsOrderAndSizeAndDropsTheWorst) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  const double worst = population.individuals().back().fitness;
  const double next = population.individuals()[38].fitness;
  const Individual tenth = population.individuals()[10];
  const double fitness = 0.5 * (tenth.fitness + population.individuals()[11].fitness);
  population.Insert(kGoal, fitness);
  ASSERT_EQ(population.individuals().size(), 40u);
  EXPECT_TRUE(IsSorted(population));
  EXPECT_EQ(population.individuals()[10].phi, tenth.phi);
  EXPECT_EQ(population.individuals()[11].phi, kGoal);
  EXPECT_EQ(population.individuals().back().fitness, next);
  EXPECT_LT(worst, next);
}

TEST(RealPopulationTest, InsertPutsTheBestFirstAndLeavesOutWhatIsWorseThanAll) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  population.Insert(kGoal, 1);
  EXPECT_EQ(population.best().phi, kGoal);
  const Individual last = population.individuals().back();
  population.Insert(PhiOf(0, 0, 1000, 0, 0, 0), last.fitness - 1);
  EXPECT_EQ(population.individuals().back().phi, last.phi);
}

TEST(RealPopulationTest, ReproduceNeverLosesTheElite) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  for (int i = 0; i < 20; ++i) {
    std::vector<Individual> elite(population.individuals().begin(),
                                  population.individuals().begin() + 8);
    EXPECT_EQ(population.Reproduce(Sphere), 32);
    for (const Individual& old : elite) {
      EXPECT_TRUE(std::any_of(population.individuals().begin(), population.individuals().end(),
                              [&](const Individual& now) { return now.phi == old.phi; }));
    }
    EXPECT_GE(population.best().fitness, elite.front().fitness);
  }
}

TEST(RealPopulationTest, ANicheEvolvesTowardsItsBestPlace) {
  int won = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    RealPopulation population = APopulation(seed);
    const Vector6d start = kGoal + PhiOf(15, -15, 25, 6, 6, -6);
    int evaluations = 0;
    const Individual best = population.Evolve(start, 80, [&](const Vector6d& phi, double) {
      EXPECT_TRUE(TestSpace().Contains(phi));
      ++evaluations;
      return Sphere(phi);
    });
    EXPECT_EQ(evaluations, 80);
    EXPECT_EQ(best.fitness, Sphere(best.phi));
    EXPECT_GE(best.fitness, Sphere(start));
    won += best.fitness > 0.25 * Sphere(start);
  }
  EXPECT_GE(won, 18);
}

TEST(RealPopulationTest, ANicheIsToldWhatAChildMustExceed) {
  RealPopulation population = APopulation();
  std::vector<double> best;  // three
  population.Evolve(kGoal, 60, [&](const Vector6d& phi, double worth) {
    const double fitness = Sphere(phi);
    if (best.empty()) {
      EXPECT_EQ(worth, -INFINITY);
      best.assign(3, fitness);
    } else {
      EXPECT_EQ(worth, best.back());
      best.push_back(fitness);
      std::sort(best.rbegin(), best.rend());
      best.pop_back();
    }
    return fitness;
  });
}

TEST(RealPopulationTest, ShootCoversThePositionsEvenly) {
  RealPopulation population = APopulation();
  population.Evaluate([](const Vector6d&) { return 0.0; });
  constexpr int kCells = 5, kShots = 2500;
  std::array<int, kCells * kCells * kCells> hits{};
  const SearchSpace space = TestSpace();
  population.Shoot(kShots, [&](const Vector6d& phi, double) {
    int cell = 0;
    for (int k = 0; k < 3; ++k) {
      const double share = (phi[k] - space.min[k]) / (space.max[k] - space.min[k]);
      cell = kCells * cell + std::min(static_cast<int>(kCells * share), kCells - 1);
    }
    ++hits[static_cast<std::size_t>(cell)];
    return -1.0;
  });
  // 20 a cell; independent random places would leave cells below 10 and above 32.
  EXPECT_GE(*std::min_element(hits.begin(), hits.end()), 14);
  EXPECT_LE(*std::max_element(hits.begin(), hits.end()), 26);
}

TEST(RealPopulationTest, ShotsAreMostlyUprightAndTheBestAreKeptInOrder) {
  RealPopulation population = APopulation();
  std::vector<double> all;
  int upright = 0;
  double last_worth = -INFINITY;
  const std::vector<Individual>& best =
      population.Shoot(400, [&](const Vector6d& phi, double worth) {
        upright += phi.tail<3>().cwiseAbs().maxCoeff() < 0.6 * TestSpace().max[3];
        EXPECT_GE(worth, last_worth);
        last_worth = worth;
        all.push_back(Sphere(phi));
        return all.back();
      });
  EXPECT_EQ(all.size(), 400u);
  EXPECT_GT(upright, 200);  // uniform angles: 86
  std::sort(all.rbegin(), all.rend());
  ASSERT_EQ(best.size(), RealPopulation::kMostShots);
  for (std::size_t i = 0; i < best.size(); ++i) EXPECT_EQ(best[i].fitness, all[i]) << i;
}

TEST(RealPopulationTest, ShotsOfEarlierAreForgotten) {
  RealPopulation population = APopulation();
  population.Shoot(200, ShotSphere);
  EXPECT_EQ(population.Shoot(7, ShotSphere).size(), 7u);
}

TEST(RealPopulationTest, RenewKeepsTheBestShare) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  const std::vector<Individual> before = population.individuals();
  population.Renew(0.3);
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(population.individuals()[i].phi == before[i].phi, i < 12) << i;
    EXPECT_EQ(population.individuals()[i].evaluated, i < 12) << i;
  }
  ExpectWithinSpace(population);
}

TEST(RealPopulationTest, MoveCarriesEveryoneAndMakesFitnessOutOfDate) {
  RealPopulation population = APopulation();
  population.Evaluate(Sphere);
  const std::vector<Individual> before = population.individuals();
  const Vector6d by = PhiOf(10, 20, 300, 1, 2, 3);
  population.Move([&](Vector6d* phi) { *phi += by; });
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_LT((population.individuals()[i].phi - before[i].phi - by).norm(), 1e-12);
    EXPECT_FALSE(population.individuals()[i].evaluated);
  }
  population.Evaluate(Sphere);
  ExpectWithinSpace(population);  // those carried out of it are clamped
}

TEST(RealPopulationTest, TheSameSeedGivesTheSamePopulationAnotherSeedAnother) {
  const auto run = [](std::uint64_t seed) {
    RealPopulation population = APopulation(seed);
    population.Evaluate(Sphere);
    for (const Individual& shot : population.Shoot(50, ShotSphere))
      population.Insert(shot.phi, shot.fitness);
    for (int i = 0; i < 5; ++i) population.Reproduce(Sphere);
    std::vector<double> numbers;
    for (const Individual& individual : population.individuals()) {
      numbers.insert(numbers.end(), individual.phi.begin(), individual.phi.end());
      numbers.push_back(individual.fitness);
    }
    return numbers;
  };
  EXPECT_EQ(run(7), run(7));
  EXPECT_NE(run(7), run(8));
}

TEST(RealPopulationTest, EqualFitnessKeepsItsOrder) {
  RealPopulation population = APopulation();
  const std::vector<Individual> before = population.individuals();
  population.Evaluate([](const Vector6d&) { return 0.25; });
  for (std::size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(population.individuals()[i].phi, before[i].phi);
  }
}

TEST(RealPopulationTest, FindsTheTopOfAHillInSixDimensions) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    RealPopulation population = APopulation(seed);
    population.Evaluate(Sphere);
    for (int i = 0; i < 40; ++i) population.Reproduce(Sphere);
    const Vector6d off = (population.best().phi - kGoal).cwiseQuotient(TestSpace().range());
    EXPECT_LT(off.norm(), 0.03) << seed;
  }
}

TEST(RealPopulationTest, NothingIsAllocatedAfterConstruction) {
  if (NumMallocs() < 0) GTEST_SKIP() << "a sanitizer owns the allocator";
  RealPopulation population = APopulation();
  const RealPopulation::FitnessFunction fitness = Sphere;
  const RealPopulation::ShotFitness shot_fitness = ShotSphere;
  const std::function<void(Vector6d*)> move = [](Vector6d* phi) { (*phi)[0] += 0.001; };
  const std::int64_t before = NumMallocs();
  population.Evaluate(fitness);
  population.Reproduce(fitness);
  population.Shoot(300, shot_fitness);
  population.Insert(kGoal, 0);
  population.Move(move);
  population.Renew(0.3);
  population.Evaluate(fitness);
  EXPECT_EQ(NumMallocs(), before);
}

}  // namespace
}  // namespace visavis
