#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/config/rule.h"
#include "common/core/random.h"
#include "services/recogniser/genetic_algorithm.h"
#include "services/recogniser/search_space.h"

namespace visavis {

/// The real-coded GA of the refined estimator.
struct RealGaConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("individuals", &individuals, InRange(10, 1000));
    a->Visit("elite_share", &elite_share, InRange(0.0, 0.9));
    a->Visit("tournament", &tournament, InRange(1, 10));
    a->Visit("immigrant_share", &immigrant_share, InRange(0.0, 0.9));
    a->Visit("mutation_probability", &mutation_probability, InRange(0.0, 1.0));
  }
  int individuals{30};
  double elite_share{0.2};
  int tournament{3};
  double immigrant_share{0.1};        ///< of the children: new, anywhere in the space
  double mutation_probability{0.35};  ///< of each parameter
};

/// A small population of poses, fittest first. Children blend two parents (BLX with 0.3) and mutate
/// at scales from a quarter of the range down to a six-hundredth. Nothing is allocated after
/// construction.
class RealPopulation {
 public:
  using FitnessFunction = std::function<double(const Vector6d&)>;

  RealPopulation(const RealGaConfig& config, std::uint64_t seed);

  void SetSpace(const SearchSpace& space) { space_ = space; }
  const SearchSpace& space() const { return space_; }
  /// All anew, anywhere in the space.
  void Restart();
  /// The best @p share stays, the others are new.
  void Renew(double share);
  /// Moves every individual, for instance by feedforward; fitness is out of date then.
  void Move(const std::function<void(Vector6d*)>& move);

  /// Fitness of all under the current pictures; sorts. @return evaluations.
  int Evaluate(const FitnessFunction& fitness);
  /// @p count poses, evenly spread over the positions and with random angles, mostly small.
  /// @return the best kMostShots of them, fittest first, until the next call. @p fitness is told
  /// what a shot must exceed to be among them.
  using ShotFitness = std::function<double(const Vector6d& phi, double worth)>;
  const std::vector<Individual>& Shoot(int count, const ShotFitness& fitness);
  static constexpr std::size_t kMostShots = 120;
  /// Evolution of a niche: children of the @p niche's few best, each generation nearer to them. The
  /// niche is that of its best at the end.
  Individual Evolve(const Vector6d& niche, int evaluations, const ShotFitness& fitness);
  /// One generation: the elite stays, children take the places of the rest. @return evaluations.
  int Reproduce(const FitnessFunction& fitness);
  /// Takes @p phi in, in the worst's place.
  void Insert(const Vector6d& phi, double fitness);

  const std::vector<Individual>& individuals() const { return individuals_; }
  const Individual& best() const { return individuals_.front(); }

 private:
  Vector6d RandomPose();
  Vector6d Child();
  void Sort();

  RealGaConfig config_;
  SearchSpace space_;
  Random random_;
  std::vector<Individual> individuals_, children_, shots_;
};

}  // namespace visavis
