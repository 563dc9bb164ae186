// The GA engine beside pagmo2's sga and de: the same population, the same six parameters, the same
// cheap problem, so that what is timed is the engine and not the fitness. Items are generations.
#include <benchmark/benchmark.h>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "services/recogniser/genetic_algorithm.h"

namespace visavis {
namespace {

constexpr int kIndividuals = 60, kGenerations = 200;

double Cost(const double* x) {
  double sum = 0;
  for (int k = 0; k < 6; ++k) sum += (x[k] - 0.1 * k) * (x[k] - 0.1 * k);
  return sum;
}

struct Sphere {
  pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {Cost(x.data())}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {pagmo::vector_double(6, -1.0), pagmo::vector_double(6, 1.0)};
  }
};

void BM_OurEngine(benchmark::State& state) {
  SearchSpace space;
  space.min.setConstant(-1);
  space.max.setConstant(1);
  double best = 0;
  for (auto _ : state) {
    GeneticAlgorithm ga(GaConfig{}, space, 1);
    const auto fitness = [](const Vector6d& phi) { return -Cost(phi.data()); };
    ga.Evaluate(fitness);
    for (int i = 0; i < kGenerations; ++i) {
      ga.Reproduce();
      ga.Evaluate(fitness);
    }
    best = -ga.best().fitness;
  }
  state.SetItemsProcessed(state.iterations() * kGenerations);
  if (best > 0.05) state.SkipWithError("did not converge");
}
BENCHMARK(BM_OurEngine)->Unit(benchmark::kMillisecond);

template <typename Algorithm>
void RunPagmo(benchmark::State& state, const Algorithm& settings) {
  double best = 0;
  for (auto _ : state) {
    pagmo::population population(Sphere{}, kIndividuals, 1u);
    population = pagmo::algorithm(settings).evolve(population);
    best = population.champion_f()[0];
  }
  state.SetItemsProcessed(state.iterations() * kGenerations);
  if (best > 0.05) state.SkipWithError("did not converge");
}

void BM_PagmoSga(benchmark::State& state) { RunPagmo(state, pagmo::sga(kGenerations)); }
BENCHMARK(BM_PagmoSga)->Unit(benchmark::kMillisecond);

// No early stop: xtol and ftol 0.
void BM_PagmoDe(benchmark::State& state) {
  RunPagmo(state, pagmo::de(kGenerations, 0.8, 0.9, 2u, 0, 0));
}
BENCHMARK(BM_PagmoDe)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace visavis
