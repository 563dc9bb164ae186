#include "services/recogniser/refined/real_population.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace visavis {
namespace {

constexpr double kBlend = 0.3;          ///< how far children lie beyond their parents
constexpr double kLargestScale = 0.25;  ///< of a mutation, in ranges
constexpr double kAngleSigma = 0.2;     ///< of shots' angles, in ranges
constexpr double kDecades = 2.2;        ///< between the largest scale and the smallest

constexpr int kNicheParents = 3;
constexpr double kNarrowest = 0.15;  ///< of the first generation's spread, in a niche
constexpr double kNicheSigma[6] = {0.012, 0.016, 0.030, 0.12, 0.20, 0.20};  ///< m, rad

bool IsFitter(const Individual& a, const Individual& b) { return a.fitness > b.fitness; }

}  // namespace

RealPopulation::RealPopulation(const RealGaConfig& config, std::uint64_t seed)
    : config_(config),
      space_(SearchSpace::FromConfig({})),
      random_(seed),
      individuals_(static_cast<std::size_t>(config.individuals)) {
  children_.reserve(individuals_.size());
  shots_.reserve(kMostShots);
  Restart();
}

Vector6d RealPopulation::RandomPose() {
  Vector6d phi;
  for (int k = 0; k < 6; ++k) phi[k] = random_.Uniform(space_.min[k], space_.max[k]);
  return phi;
}

void RealPopulation::Restart() { Renew(0); }

void RealPopulation::Renew(double share) {
  const auto kept =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(individuals_.size())));
  for (std::size_t i = kept; i < individuals_.size(); ++i)
    individuals_[i] = {RandomPose(), 0, false};
}

void RealPopulation::Move(const std::function<void(Vector6d*)>& move) {
  for (Individual& individual : individuals_) {
    move(&individual.phi);
    individual.evaluated = false;
  }
}

// Insertion, which is stable and, unlike std::stable_sort, allocates nothing.
void RealPopulation::Sort() {
  for (auto it = individuals_.begin(); it != individuals_.end(); ++it) {
    const auto place = std::upper_bound(individuals_.begin(), it, *it, IsFitter);
    std::rotate(place, it, it + 1);
  }
}

int RealPopulation::Evaluate(const FitnessFunction& fitness) {
  for (Individual& individual : individuals_) {
    individual.phi = space_.Clamp(individual.phi);
    individual.fitness = fitness(individual.phi);
    individual.evaluated = true;
  }
  Sort();
  return static_cast<int>(individuals_.size());
}

Individual RealPopulation::Evolve(const Vector6d& niche, int evaluations,
                                  const ShotFitness& fitness) {
  std::array<Individual, kNicheParents> best;
  best.fill({niche, fitness(niche, -INFINITY), true});
  for (int i = 1; i < evaluations; ++i) {
    const double scale = std::pow(kNarrowest, static_cast<double>(i) / evaluations);
    Vector6d phi = best[static_cast<std::size_t>(random_.Index(kNicheParents))].phi;
    for (int k = 0; k < 6; ++k) phi[k] += scale * kNicheSigma[k] * random_.Normal();
    phi = space_.Clamp(phi);
    const Individual child{phi, fitness(phi, best.back().fitness), true};
    const auto place = std::upper_bound(best.begin(), best.end(), child, IsFitter);
    if (place == best.end()) continue;
    std::move_backward(place, best.end() - 1, best.end());
    *place = child;
  }
  return best[0];
}

void RealPopulation::Insert(const Vector6d& phi, double fitness) {
  const Individual individual{phi, fitness, true};
  const auto place = std::find_if(individuals_.begin(), individuals_.end(),
                                  [&](const Individual& other) { return other.fitness < fitness; });
  if (place == individuals_.end()) return;
  std::move_backward(place, individuals_.end() - 1, individuals_.end());
  *place = individual;
}

const std::vector<Individual>& RealPopulation::Shoot(int count, const ShotFitness& fitness) {
  // Positions from an additive recurrence that fills space evenly, begun at random.
  constexpr double kRatios[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
  double place[3] = {random_.Uniform(), random_.Uniform(), random_.Uniform()};
  shots_.clear();
  for (int i = 0; i < count; ++i) {
    Vector6d phi;
    for (int k = 0; k < 3; ++k) {
      place[k] = std::fmod(place[k] + kRatios[k], 1.0);
      phi[k] = space_.min[k] + place[k] * (space_.max[k] - space_.min[k]);
    }
    for (int k = 3; k < 6; ++k) {
      phi[k] = 0.5 * (space_.min[k] + space_.max[k]) +
               kAngleSigma * (space_.max[k] - space_.min[k]) * random_.Normal();
    }
    phi = space_.Clamp(phi);
    const bool is_full = shots_.size() == kMostShots;
    const double worth = is_full ? shots_.back().fitness : -INFINITY;
    const Individual shot{phi, fitness(phi, worth), true};
    if (shot.fitness <= worth) continue;
    if (is_full) shots_.pop_back();
    shots_.insert(std::upper_bound(shots_.begin(), shots_.end(), shot, IsFitter), shot);
  }
  return shots_;
}

Vector6d RealPopulation::Child() {
  if (random_.Uniform() < config_.immigrant_share) return RandomPose();
  const auto parent = [&]() -> const Vector6d& {  // the population is sorted
    int best = random_.Index(config_.individuals);
    for (int i = 1; i < config_.tournament; ++i)
      best = std::min(best, random_.Index(config_.individuals));
    return individuals_[static_cast<std::size_t>(best)].phi;
  };
  const Vector6d &a = parent(), &b = parent();
  const double scale = kLargestScale * std::pow(10, -kDecades * random_.Uniform());
  Vector6d child;
  for (int k = 0; k < 6; ++k) {
    const double low = std::min(a[k], b[k]), high = std::max(a[k], b[k]);
    const double beyond = kBlend * (high - low);
    child[k] = random_.Uniform(low - beyond, high + beyond);
    if (random_.Uniform() < config_.mutation_probability)
      child[k] += scale * (space_.max[k] - space_.min[k]) * random_.Normal();
  }
  return space_.Clamp(child);
}

int RealPopulation::Reproduce(const FitnessFunction& fitness) {
  const auto elite = static_cast<std::size_t>(
      std::lround(config_.elite_share * static_cast<double>(individuals_.size())));
  children_.clear();
  while (elite + children_.size() < individuals_.size()) {
    const Vector6d phi = Child();
    children_.push_back({phi, fitness(phi), true});
  }
  std::copy(children_.begin(), children_.end(),
            individuals_.begin() + static_cast<std::ptrdiff_t>(elite));
  Sort();
  return static_cast<int>(children_.size());
}

}  // namespace visavis
