// pagmo2's sga, de and cmaes on the refined estimator's fitness, from an unknown pose: evaluations
// and time until the best individual is within 5 mm of the head, beside ours: shots and GA alone,
// and with the best individual refined. A run that does not come there in 20000 evaluations ends.
#include <benchmark/benchmark.h>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>

#include "services/recogniser/refined/mesh_fitness.h"
#include "services/recogniser/refined/pose_refiner.h"
#include "services/recogniser/refined/real_population.h"
#include "services/recogniser/refined/refined_config.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

constexpr int kMost = 20000, kIndividuals = 60, kSeeds = 10;
constexpr double kThere_m = 0.005;

struct Scene {
  Scene() : view(&scene.Show(TransformFromPhi(truth), FeaturedHead)) {}
  double Fitness(const Vector6d& phi) const {
    return fitness.Evaluate(*view, TransformFromPhi(phi)).total();
  }
  double Distance(const Vector6d& phi) const { return (phi - truth).head<3>().norm(); }

  const Vector6d truth = PhiOf(60, -40, 1080, 6, -8, 5);
  const SearchSpace space = SearchSpace::FromConfig({});
  const SharedHead& head = SharedAdultHead();
  MeshScene scene{TestRig()};
  const StereoView* view;
  MeshFitness fitness{MeshOf(head.surface, 3), head.face, 2};
};

Scene& TheScene() {
  static Scene scene;
  return scene;
}

/// What one run took; evaluations above kMost: not there.
struct Tally {
  int runs{0}, there{0};
  double evaluations{0};
  void Add(int count, bool is_there) {
    ++runs;
    there += is_there;
    evaluations += count;
  }
  void Report(benchmark::State& state) const {
    state.counters["evaluations"] = evaluations / runs;
    state.counters["there_percent"] = 100.0 * there / runs;
  }
};

struct Problem {
  pagmo::vector_double fitness(const pagmo::vector_double& x) const {
    return {-TheScene().Fitness(Eigen::Map<const Vector6d>(x.data()))};
  }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    const SearchSpace& space = TheScene().space;
    return {pagmo::vector_double(space.min.begin(), space.min.end()),
            pagmo::vector_double(space.max.begin(), space.max.end())};
  }
};

template <typename Algorithm>
void RunPagmo(benchmark::State& state, const Algorithm& generation) {
  Tally tally;
  for (auto _ : state) {
    pagmo::population population(Problem{}, kIndividuals, static_cast<unsigned>(1 + tally.runs));
    pagmo::algorithm algorithm(generation);
    algorithm.set_verbosity(0);
    const auto distance = [&] {
      return TheScene().Distance(Eigen::Map<const Vector6d>(population.champion_x().data()));
    };
    int evaluations = kIndividuals;
    while (distance() > kThere_m && evaluations < kMost) {
      population = algorithm.evolve(population);
      evaluations += kIndividuals;
    }
    tally.Add(evaluations, distance() <= kThere_m);
  }
  tally.Report(state);
}

void BM_RefinedPagmoSga(benchmark::State& state) { RunPagmo(state, pagmo::sga(1)); }
BENCHMARK(BM_RefinedPagmoSga)->Iterations(kSeeds)->Unit(benchmark::kMillisecond);
void BM_RefinedPagmoDe(benchmark::State& state) {
  RunPagmo(state, pagmo::de(1, 0.8, 0.9, 2u, 0, 0));
}
BENCHMARK(BM_RefinedPagmoDe)->Iterations(kSeeds)->Unit(benchmark::kMillisecond);
// Keeps its memory from generation to generation; bounds forced; no early stop.
void BM_RefinedPagmoCmaes(benchmark::State& state) {
  RunPagmo(state, pagmo::cmaes(1, -1, -1, -1, -1, 0.3, 0, 0, true, true));
}
BENCHMARK(BM_RefinedPagmoCmaes)->Iterations(kSeeds)->Unit(benchmark::kMillisecond);

// Shots, then generations.
void RunOurs(benchmark::State& state, bool refine) {
  Scene& s = TheScene();
  PoseRefiner refiner({}, s.head.surface, s.head.mesh, s.head.face);
  Tally tally;
  for (auto _ : state) {
    RealPopulation population({}, static_cast<std::uint64_t>(1 + tally.runs));
    population.SetSpace(s.space);
    population.Restart();
    int evaluations = 0;
    const auto fitness = [&](const Vector6d& phi) {
      ++evaluations;
      return s.Fitness(phi);
    };
    population.Evaluate(fitness);
    const auto shot_fitness = [&](const Vector6d& phi, double) { return fitness(phi); };
    for (const Individual& shot : population.Shoot(RefinedConfig{}.search_shots, shot_fitness))
      population.Insert(shot.phi, shot.fitness);
    const auto distance = [&] {
      if (!refine) return s.Distance(population.best().phi);
      const RigidTransform X_CM = TransformFromPhi(population.best().phi);
      return s.Distance(PhiFromTransform(refiner.Refine(*s.view, X_CM, nullptr, 8, 10).X_CM));
    };
    while (distance() > kThere_m && evaluations < kMost) population.Reproduce(fitness);
    tally.Add(evaluations, distance() <= kThere_m);
  }
  tally.Report(state);
}
void BM_RefinedOursGa(benchmark::State& state) { RunOurs(state, false); }
BENCHMARK(BM_RefinedOursGa)->Iterations(kSeeds)->Unit(benchmark::kMillisecond);
void BM_RefinedOurs(benchmark::State& state) { RunOurs(state, true); }
BENCHMARK(BM_RefinedOurs)->Iterations(kSeeds)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace visavis
