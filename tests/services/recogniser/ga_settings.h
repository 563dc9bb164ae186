#pragma once

#include "services/recogniser/genetic_algorithm.h"
#include "tests/support/stereo_scene.h"

namespace visavis {

/// The box that the tests search.
inline SearchSpace ASpace() {
  return {PhiOf(-200, -200, 900, -20, -20, -20), PhiOf(200, 200, 1200, 20, 20, 20)};
}

/// The engine's parts one at a time: nothing survives, mutates, crosses or immigrates unless a test
/// says so.
inline GaConfig Inert(int individuals) {
  GaConfig config;
  config.individuals = individuals;
  config.bits_per_parameter = 8;
  config.elite_share = config.immigrant_share = 0;
  config.tournament = 1;
  config.crossover_probability = config.mutation_probability = 0;
  config.carry_remainder = true;
  return config;
}

/// All operators at work.
inline GaConfig Working() {
  GaConfig config = Inert(60);
  config.elite_share = 0.25;
  config.immigrant_share = 0.1;
  config.tournament = 2;
  config.crossover_probability = 1;
  config.mutation_probability = 0.04;
  return config;
}

/// One maximum, 0, inside the space.
inline double SmoothFitness(const Vector6d& phi) {
  const Vector6d target = PhiOf(60, -80, 1010, 7, -3, 11);
  return -(phi - target).cwiseQuotient(ASpace().range()).squaredNorm();
}

}  // namespace visavis
