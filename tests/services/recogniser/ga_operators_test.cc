// Selection, crossover, mutation and immigrants, each on its own; and the rules of GaConfig.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cmath>
#include <vector>

#include "common/config/config_reader.h"
#include "services/recogniser/genetic_algorithm.h"
#include "tests/services/recogniser/ga_settings.h"
#include "tests/support/config_refusal.h"

namespace visavis {
namespace {

// Gives each individual its own phi.
template <typename PhiOfIndex>
void SetPopulation(const PhiOfIndex& phi_of, GeneticAlgorithm* ga) {
  int i = 0;
  ga->Move([&](Vector6d* phi) { *phi = phi_of(i++); });
}

int CountFlips(const GaConfig& config, int generations, std::array<int, 48>* by_bit) {
  GeneticAlgorithm ga(config, ASpace(), 7);
  const GeneCodec codec(ASpace(), 8);
  const std::uint64_t gene = 0x5a3c96f01e2dull;
  int flips = 0;
  for (int i = 0; i < generations; ++i) {
    ga.Scatter(codec.Decode(gene), Vector6d::Zero());
    ga.Reproduce();
    for (const Individual& individual : ga.population()) {
      const std::bitset<48> flipped(codec.Encode(individual.phi) ^ gene);
      flips += static_cast<int>(flipped.count());
      for (std::size_t bit = 0; bit < 48; ++bit) (*by_bit)[bit] += flipped[bit];
    }
  }
  return flips;
}

TEST(GaOperatorsTest, EachBitMutatesWithTheGivenProbability) {
  for (const double probability : {0.01, 0.05, 0.3}) {
    GaConfig config = Inert(1000);
    config.mutation_probability = probability;
    std::array<int, 48> by_bit{};
    const double children = 10 * 1000.0;
    const double flips = CountFlips(config, 10, &by_bit);
    const double variance = children * probability * (1 - probability);
    EXPECT_NEAR(flips, 48 * children * probability, 5 * std::sqrt(48 * variance)) << probability;
    for (std::size_t bit = 0; bit < 48; ++bit) {
      EXPECT_NEAR(by_bit[bit], children * probability, 5 * std::sqrt(variance)) << bit;
    }
  }
}

TEST(GaOperatorsTest, MutationProbability0ChangesNoBitAnd1ChangesAll) {
  std::array<int, 48> by_bit{};
  GaConfig config = Inert(100);
  EXPECT_EQ(CountFlips(config, 1, &by_bit), 0);
  config.mutation_probability = 1;
  EXPECT_EQ(CountFlips(config, 1, &by_bit), 4800);
}

// Two kinds of parents, all bits 0 and all bits 1. The remainder, which stays the mother's, tells
// the mother; the bits that differ from hers are the father's.
TEST(GaOperatorsTest, CrossoverTakesOneSegmentOfTheFatherAndAnyBitMayBeInIt) {
  GaConfig config = Inert(2000);
  config.crossover_probability = 1;
  const GeneCodec codec(ASpace(), 8);
  const std::uint64_t ones = (std::uint64_t{1} << 48) - 1;
  GeneticAlgorithm ga(config, ASpace(), 8);
  SetPopulation(
      [&](int i) -> Vector6d {
        if (i % 2 == 1) return ASpace().max - 0.2 * codec.step();
        return ASpace().min + 0.2 * codec.step();
      },
      &ga);
  ga.Reproduce();
  std::array<int, 48> from_father{};
  int crossed = 0;
  for (const Individual& child : ga.population()) {
    const std::uint64_t gene = codec.Encode(child.phi);
    // At the space's border the remainder is cut off, but never in all parameters.
    const Vector6d remainder = (child.phi - codec.Decode(gene)).cwiseQuotient(codec.step());
    const bool mother_is_ones = remainder.sum() < 0;
    const std::uint64_t segment = gene ^ (mother_is_ones ? ones : 0);
    // One run of bits: adding its lowest bit carries through the run.
    const std::uint64_t lowest = segment & (~segment + 1);
    EXPECT_EQ((segment + lowest) & segment, 0u) << std::bitset<48>(segment);
    if (segment != 0) ++crossed;
    for (std::size_t bit = 0; bit < 48; ++bit) from_father[bit] += (segment >> bit & 1) != 0;
  }
  EXPECT_NEAR(crossed, 1000, 150);  // else mother and father were of one kind
  for (std::size_t bit = 0; bit < 48; ++bit) EXPECT_GT(from_father[bit], 5) << "bit " << bit;
  EXPECT_GT(from_father[24], 300);
}

TEST(GaOperatorsTest, WithoutCrossoverAndMutationChildrenAreTheirMothers) {
  GeneticAlgorithm ga(Inert(40), ASpace(), 9);
  const std::vector<Individual> parents = ga.population();
  ga.Reproduce();
  for (const Individual& child : ga.population()) {
    EXPECT_TRUE(std::any_of(parents.begin(), parents.end(), [&](const Individual& parent) {
      return (parent.phi - child.phi).norm() < 1e-12;
    }));
  }
}

// The better half holds a parent with probability 1 - (1/2)^tournament.
TEST(GaOperatorsTest, TournamentsPreferTheFitter) {
  for (const int tournament : {1, 2, 4}) {
    GaConfig config = Inert(2000);
    config.tournament = tournament;
    GeneticAlgorithm ga(config, ASpace(), 10);
    const auto fitness = [](const Vector6d& phi) { return phi[0]; };
    ga.Evaluate(fitness);
    const double median = ga.population()[1000].phi[0];
    ga.Reproduce();
    const auto better = std::count_if(ga.population().begin(), ga.population().end(),
                                      [&](const auto& child) { return child.phi[0] > median; });
    EXPECT_NEAR(static_cast<double>(better) / 2000, 1 - std::pow(0.5, tournament), 0.06)
        << tournament;
  }
}

TEST(GaOperatorsTest, ImmigrantsAreTheGivenShareAndComeFromEverywhere) {
  GaConfig config = Inert(1000);
  config.immigrant_share = 0.3;
  GeneticAlgorithm ga(config, ASpace(), 11);
  const Vector6d home = PhiOf(10, 20, 1000, 1, 2, 3);
  ga.Scatter(home, Vector6d::Zero());
  ga.Reproduce();
  int immigrants = 0, left = 0;
  for (const Individual& individual : ga.population()) {
    EXPECT_FALSE(individual.evaluated);
    ASSERT_TRUE(ASpace().Contains(individual.phi));
    if ((individual.phi - home).norm() < 1e-9) continue;
    ++immigrants;
    left += individual.phi[0] < 0;
  }
  EXPECT_EQ(immigrants, 300);
  EXPECT_NEAR(left, 150, 45);
}

TEST(GaConfigTest, AShareThatLeavesNoChildrenIsRefused) {
  GaConfig config = Inert(60);
  config.elite_share = 0.6, config.immigrant_share = 0.4;
  ExpectRefusal([&] { config.ValidateOrThrow("ga."); }, "ga.immigrant_share", "0.4",
                "ga.elite_share");
  ExpectRefusal([&] { GeneticAlgorithm ga(config, ASpace(), 1); }, "ga.immigrant_share", "0.4",
                "children");
}

// Shares are rounded to individuals: it is these that must leave room.
TEST(GaConfigTest, AFewIndividualsLeaveAtLeastOneChild) {
  GaConfig config = Inert(4);
  config.elite_share = 0.5, config.immigrant_share = 0.4;  // 2 and 2
  ExpectRefusal([&] { config.ValidateOrThrow("ga."); }, "ga.immigrant_share", "0.4", "children");
  config.elite_share = 0.9, config.immigrant_share = 0;  // 4
  ExpectRefusal([&] { config.ValidateOrThrow("ga."); }, "ga.immigrant_share", "0", "children");
  config.elite_share = 0.5, config.immigrant_share = 0.25;
  EXPECT_NO_THROW(config.ValidateOrThrow("ga."));
}

struct GaFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("ga", &ga);
  }
  void ValidateOrThrow() const {}
  GaConfig ga;
};

TEST(GaConfigTest, EachKeyHoldsItsRange) {
  const std::pair<const char*, const char*> refused[] = {{"individuals", "3"},
                                                         {"individuals", "10001"},
                                                         {"bits_per_parameter", "3"},
                                                         {"bits_per_parameter", "11"},
                                                         {"elite_share", "-0.1"},
                                                         {"elite_share", "0.95"},
                                                         {"tournament", "0"},
                                                         {"tournament", "11"},
                                                         {"crossover_probability", "2"},
                                                         {"mutation_probability", "-1"},
                                                         {"immigrant_share", ".nan"},
                                                         {"carry_remainder", "perhaps"}};
  for (const auto& [key, value] : refused) {
    EXPECT_THAT([&] { LoadConfig<GaFile>("", {std::string("ga.") + key + "=" + value}); },
                ::testing::ThrowsMessage<ConfigError>(
                    ::testing::AllOf(::testing::HasSubstr(key), ::testing::HasSubstr(value),
                                     ::testing::HasSubstr("must be"))))
        << key << ' ' << value;
  }
}

}  // namespace
}  // namespace visavis
