#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "services/recogniser/search_space.h"

namespace visavis {

/// The published elitist GA over binary genes.
struct GaConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("individuals", &individuals, InRange(4, 10000));
    a->Visit("bits_per_parameter", &bits_per_parameter, InRange(4, 10));
    a->Visit("elite_share", &elite_share, InRange(0.0, 0.9));
    a->Visit("tournament", &tournament, InRange(1, 10));
    a->Visit("crossover_probability", &crossover_probability, InRange(0.0, 1.0));
    a->Visit("mutation_probability", &mutation_probability, InRange(0.0, 1.0));
    a->Visit("immigrant_share", &immigrant_share, InRange(0.0, 0.9));
    a->Visit("carry_remainder", &carry_remainder);
  }
  /// @throws FieldError, keys under @p prefix.
  void ValidateOrThrow(const std::string& prefix) const;

  /// Shares in whole individuals.
  int num_elite() const { return static_cast<int>(std::lround(elite_share * individuals)); }
  int num_immigrants() const {
    return static_cast<int>(std::lround(immigrant_share * individuals));
  }

  int individuals{60};
  int bits_per_parameter{8};          ///< 6 parameters, so 48 bits a gene as published
  double elite_share{0.4};            ///< best individuals that survive unchanged
  int tournament{2};                  ///< parents are the best of so many drawn
  double crossover_probability{1.0};  ///< of two-point crossover, else a copy
  double mutation_probability{0.03};  ///< of each bit
  double immigrant_share{0.1};        ///< new random individuals each generation
  /// true: what the bits cannot express stays beside them in floating point, so that feedforward
  /// below one step is not lost. false: as printed.
  bool carry_remainder{true};
};

/// phi as a gene: bits_per_parameter bits a parameter, t_x in the lowest.
class GeneCodec {
 public:
  GeneCodec(const SearchSpace& space, int bits_per_parameter);

  /// The nearest gene; phi outside the space counts as its border.
  std::uint64_t Encode(const Vector6d& phi) const;
  Vector6d Decode(std::uint64_t gene) const;
  int num_bits() const { return 6 * bits_; }
  /// Width of one step of each parameter [m, rad].
  const Vector6d& step() const { return step_; }

 private:
  int bits_;
  Vector6d min_, step_;
};

struct Individual {
  Vector6d phi{Vector6d::Zero()};  ///< m, rad; in the search space
  double fitness{0};
  bool evaluated{false};  ///< whether fitness belongs to phi and the current images
};

/// Elitist GA with selection, crossover and mutation of binary genes (Fig. 9), maximising. It
/// knows nothing of images: the caller evaluates. After construction nothing is allocated.
class GeneticAlgorithm {
 public:
  /// A random population in @p space. @throws FieldError as GaConfig::ValidateOrThrow.
  GeneticAlgorithm(const GaConfig& config, const SearchSpace& space, std::uint64_t seed);

  /// A new random population; the random sequence goes on.
  void Restart();

  /// A population scattered round @p phi: normal with @p spread (standard deviations; m, rad).
  void Scatter(const Vector6d& phi, const Vector6d& spread);

  /// Replaces the search space; individuals outside are clamped into it, and no longer evaluated.
  void SetSpace(const SearchSpace& space);
  const SearchSpace& space() const { return space_; }

  /// Marks every individual as not evaluated: the images are new.
  void Invalidate();

  /// Moves each individual: @p carry changes its phi (feedforward, Eq. 16).
  template <typename Carry>
  void Move(const Carry& carry) {
    for (Individual& individual : population_) {
      carry(&individual.phi);
      Settle(&individual);
    }
  }

  /// Evaluates who is not yet, with @p fitness(phi), and sorts, best first. @return evaluations.
  template <typename FitnessFunction>
  int Evaluate(const FitnessFunction& fitness) {
    int evaluations = 0;
    for (Individual& individual : population_) {
      if (individual.evaluated) continue;
      individual.fitness = fitness(individual.phi);
      individual.evaluated = true;
      ++evaluations;
    }
    Sort();
    return evaluations;
  }

  /// Makes the next generation out of the sorted population: elite, children, immigrants.
  void Reproduce();

  const std::vector<Individual>& population() const { return population_; }
  const Individual& best() const { return population_.front(); }

 private:
  void Sort();
  void Settle(Individual* individual) const;
  Vector6d RandomPhi();
  int SelectParent();
  Vector6d MakeChild(const Vector6d& mother, const Vector6d& father);

  const GaConfig config_;
  SearchSpace space_;
  GeneCodec codec_;
  Random random_;
  std::vector<Individual> population_, next_;
};

}  // namespace visavis
