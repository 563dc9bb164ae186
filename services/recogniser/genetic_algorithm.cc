#include "services/recogniser/genetic_algorithm.h"

#include <algorithm>
#include <cmath>

#include "common/config/config_error.h"

namespace visavis {

void GaConfig::ValidateOrThrow(const std::string& prefix) const {
  if (num_elite() + num_immigrants() >= individuals) {
    throw FieldError(
        prefix + "immigrant_share", std::to_string(immigrant_share),
        "with " + prefix + "elite_share must leave one of " + prefix + "individuals for children");
  }
}

GeneCodec::GeneCodec(const SearchSpace& space, int bits_per_parameter)
    : bits_(bits_per_parameter),
      min_(space.min),
      step_(space.range() / ((1 << bits_per_parameter) - 1)) {}

std::uint64_t GeneCodec::Encode(const Vector6d& phi) const {
  const double top = (1 << bits_) - 1;
  std::uint64_t gene = 0;
  for (int k = 0; k < 6; ++k) {
    const double level = std::clamp((phi[k] - min_[k]) / step_[k] + 0.5, 0.0, top);
    gene |= static_cast<std::uint64_t>(level) << (bits_ * k);
  }
  return gene;
}

Vector6d GeneCodec::Decode(std::uint64_t gene) const {
  const std::uint64_t mask = (std::uint64_t{1} << bits_) - 1;
  Vector6d phi;
  for (int k = 0; k < 6; ++k) {
    phi[k] = min_[k] + step_[k] * static_cast<double>((gene >> (bits_ * k)) & mask);
  }
  return phi;
}

GeneticAlgorithm::GeneticAlgorithm(const GaConfig& config, const SearchSpace& space,
                                   std::uint64_t seed)
    : config_(config),
      space_(space),
      codec_(space, config.bits_per_parameter),
      random_(seed),
      population_(static_cast<std::size_t>(config.individuals)),
      next_(population_.size()) {
  config.ValidateOrThrow("ga.");
  Restart();
}

void GeneticAlgorithm::Restart() {
  for (Individual& individual : population_) individual = {RandomPhi(), 0, false};
}

void GeneticAlgorithm::Scatter(const Vector6d& phi, const Vector6d& spread) {
  for (Individual& individual : population_) {
    individual = {};
    for (int k = 0; k < 6; ++k) individual.phi[k] = phi[k] + spread[k] * random_.Normal();
    Settle(&individual);
  }
}

void GeneticAlgorithm::SetSpace(const SearchSpace& space) {
  space_ = space;
  codec_ = GeneCodec(space, config_.bits_per_parameter);
  for (Individual& individual : population_) {
    if (space_.Contains(individual.phi)) continue;
    individual.phi = space_.Clamp(individual.phi);
    individual.evaluated = false;
  }
}

void GeneticAlgorithm::Invalidate() {
  for (Individual& individual : population_) individual.evaluated = false;
}

void GeneticAlgorithm::Settle(Individual* individual) const {
  individual->phi = config_.carry_remainder ? space_.Clamp(individual->phi)
                                            : codec_.Decode(codec_.Encode(individual->phi));
  individual->evaluated = false;
}

void GeneticAlgorithm::Sort() {
  // Equal fitness keeps its order, so that a run repeats exactly. Insertion: nearly sorted, small.
  for (std::size_t i = 1; i < population_.size(); ++i) {
    if (!(population_[i].fitness > population_[i - 1].fitness)) continue;
    const auto end = population_.begin() + static_cast<std::ptrdiff_t>(i);
    const auto at = std::upper_bound(
        population_.begin(), end, population_[i],
        [](const Individual& a, const Individual& b) { return a.fitness > b.fitness; });
    std::rotate(at, end, end + 1);
  }
}

Vector6d GeneticAlgorithm::RandomPhi() {
  Vector6d phi;
  for (int k = 0; k < 6; ++k) phi[k] = random_.Uniform(space_.min[k], space_.max[k]);
  return config_.carry_remainder ? phi : codec_.Decode(codec_.Encode(phi));
}

int GeneticAlgorithm::SelectParent() {
  int best = config_.individuals;
  for (int i = 0; i < config_.tournament; ++i)
    best = std::min(best, random_.Index(config_.individuals));
  return best;
}

Vector6d GeneticAlgorithm::MakeChild(const Vector6d& mother, const Vector6d& father) {
  const std::uint64_t mother_gene = codec_.Encode(mother);
  std::uint64_t gene = mother_gene;
  if (random_.Uniform() < config_.crossover_probability) {
    // Cuts lie between bits and at both ends, or the last bit would always be the mother's.
    int begin = random_.Index(codec_.num_bits() + 1), end = random_.Index(codec_.num_bits() + 1);
    if (begin > end) std::swap(begin, end);
    const std::uint64_t mask = ((std::uint64_t{1} << end) - 1) & ~((std::uint64_t{1} << begin) - 1);
    gene = (gene & ~mask) | (codec_.Encode(father) & mask);
  }
  // Distances between flipped bits are geometric: one draw a flip instead of one a bit.
  if (config_.mutation_probability > 0) {
    const double scale = 1 / std::log1p(-std::min(config_.mutation_probability, 1 - 1e-12));
    for (double bit = std::floor(std::log(1 - random_.Uniform()) * scale); bit < codec_.num_bits();
         bit += 1 + std::floor(std::log(1 - random_.Uniform()) * scale)) {
      gene ^= std::uint64_t{1} << static_cast<int>(bit);
    }
  }
  Vector6d child = codec_.Decode(gene);
  if (config_.carry_remainder) child += mother - codec_.Decode(mother_gene);
  return space_.Clamp(child);
}

void GeneticAlgorithm::Reproduce() {
  const int elite = config_.num_elite(), immigrants = config_.num_immigrants();
  for (int i = 0; i < config_.individuals; ++i) {
    Individual& slot = next_[static_cast<std::size_t>(i)];
    if (i < elite) {
      slot = population_[static_cast<std::size_t>(i)];
    } else if (i >= config_.individuals - immigrants) {
      slot = {RandomPhi(), 0, false};
    } else {
      const Vector6d& mother = population_[static_cast<std::size_t>(SelectParent())].phi;
      const Vector6d& father = population_[static_cast<std::size_t>(SelectParent())].phi;
      slot = {MakeChild(mother, father), 0, false};
    }
  }
  population_.swap(next_);
}

}  // namespace visavis
