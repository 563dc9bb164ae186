// Benchmarks of the refined estimator's parts on a painted head, 640 x 480. Each checks what it
// timed, and its naive double-precision twin is beside it: compare rows of one run.
#include <benchmark/benchmark.h>

#include <cmath>

#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/real_population.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/naive_bands.h"
#include "tests/support/naive_refined.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

/// Calls of the rows whose instructions an instrumented run counts.
constexpr int kCounted = 100;
constexpr int kDetail = 2;  ///< of the fitness that judges the population

struct Scene {
  Scene() {
    scene.Show(TransformFromPhi(truth), GrainyHead);
    Random random(7);
    for (Vector6d& phi : phis) {
      for (int k = 0; k < 6; ++k) phi[k] = truth[k] + (k < 3 ? 0.015 : 0.1) * random.Normal();
    }
  }
  const StereoView& view() { return scene.Show(TransformFromPhi(truth), GrainyHead); }

  const Vector6d truth = PhiOf(20, -10, 1000, 4, -5, 3);
  std::array<Vector6d, 60> phis;
  const SharedHead& head = SharedAdultHead();
  HeadMesh mesh = MeshOf(head.surface, 3);
  MeshScene scene{TestRig()};
  MeshFitness fitness{mesh, head.face, kDetail};
  NaiveMeshFitness naive_fitness{mesh, head.face, kDetail};
  PoseRefiner refiner{{}, head.surface, head.mesh, head.face};
  NaiveRefiner naive_refiner{{}, head.surface, head.mesh, head.face};
};

Scene& TheScene() {
  static Scene scene;
  return scene;
}

template <typename Fitness>
void EvaluateAll(benchmark::State& state, const Fitness& fitness) {
  Scene& s = TheScene();
  const StereoView& view = s.view();
  std::size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    sum += fitness.Evaluate(view, TransformFromPhi(s.phis[i])).total();
    i = (i + 1) % s.phis.size();
  }
  benchmark::DoNotOptimize(sum);
  const int points = 2 * s.naive_fitness.num_points();
  state.counters["points"] = points;
  state.SetItemsProcessed(state.iterations() * points);
  const double error = s.fitness.Evaluate(view, TransformFromPhi(s.truth)).total() -
                       s.naive_fitness.Evaluate(view, TransformFromPhi(s.truth)).total();
  if (std::abs(error) > 0.05) state.SkipWithError("fitness and twin differ");
}
void BM_RefinedFitness(benchmark::State& state) { EvaluateAll(state, TheScene().fitness); }
BENCHMARK(BM_RefinedFitness);
BENCHMARK(BM_RefinedFitness)->Name("CountedRefinedFitness")->Iterations(kCounted);
void BM_RefinedFitnessTwin(benchmark::State& state) {
  EvaluateAll(state, TheScene().naive_fitness);
}
BENCHMARK(BM_RefinedFitnessTwin);
BENCHMARK(BM_RefinedFitnessTwin)->Name("CountedRefinedFitnessTwin")->Iterations(kCounted);

template <typename Fitness>
void Generations(benchmark::State& state, const Fitness& fitness) {
  Scene& s = TheScene();
  const StereoView& view = s.view();
  const auto evaluate = [&](const Vector6d& phi) {
    return fitness.Evaluate(view, TransformFromPhi(phi)).total();
  };
  RealPopulation population({}, 1);
  population.SetSpace(SearchSpace::FromConfig({}));
  population.Evaluate(evaluate);
  const double first = population.best().fitness;
  for (auto _ : state) population.Reproduce(evaluate);
  if (population.best().fitness < first) state.SkipWithError("the elite was lost");
}
void BM_RefinedGeneration(benchmark::State& state) { Generations(state, TheScene().fitness); }
BENCHMARK(BM_RefinedGeneration)->Unit(benchmark::kMicrosecond);
void BM_RefinedGenerationTwin(benchmark::State& state) {
  Generations(state, TheScene().naive_fitness);
}
BENCHMARK(BM_RefinedGenerationTwin)->Unit(benchmark::kMicrosecond);

// Contours, generic face and both eyes' agreement of one pose: what an iteration adds up.
template <typename Refiner>
void Iterations(benchmark::State& state, Refiner* refiner) {
  Scene& s = TheScene();
  const StereoView& view = s.view();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(refiner->Generic(view, TransformFromPhi(s.phis[i])));
    i = (i + 1) % s.phis.size();
  }
  const RigidTransform X_CM = TransformFromPhi(s.truth);
  const PoseEquations ours = s.refiner.Generic(view, X_CM),
                      twin = s.naive_refiner.Generic(view, X_CM);
  if ((ours.H - twin.H).norm() > 0.01 * twin.H.norm())
    state.SkipWithError("equations and twin differ");
}
void BM_RefinedIteration(benchmark::State& state) { Iterations(state, &TheScene().refiner); }
BENCHMARK(BM_RefinedIteration)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_RefinedIteration)->Name("CountedRefinedIteration")->Iterations(kCounted);
void BM_RefinedIterationTwin(benchmark::State& state) {
  Iterations(state, &TheScene().naive_refiner);
}
BENCHMARK(BM_RefinedIterationTwin)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_RefinedIterationTwin)->Name("CountedRefinedIterationTwin")->Iterations(kCounted);

// Scores and bands of one whole picture.
void BM_RefinedMaps(benchmark::State& state) {
  Scene& s = TheScene();
  s.view();
  const ImageView picture = s.scene.picture(0);
  ColorModel colors;
  colors.StartFrom(picture);
  ScoreMap scores(picture.width, picture.height);
  BandImages bands(picture.width, picture.height);
  const PixelBox whole{0, 0, picture.width, picture.height};
  for (auto _ : state) {
    scores.Build(picture, colors, whole);
    bands.Build(picture, whole);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * picture.width * picture.height);
  const BandView view = bands.view(kFineBand);
  const NaiveBands twin(picture);
  for (std::size_t i = 0; i < twin.bands[kFineBand].size(); ++i) {
    const auto value = static_cast<std::int16_t>(view.pairs[i] & 0xffff);
    if (std::abs(static_cast<double>(value) / kBandSteps - twin.bands[kFineBand][i]) > 0.1)
      state.SkipWithError("bands and twin differ");
  }
}
BENCHMARK(BM_RefinedMaps)->Unit(benchmark::kMicrosecond);
void BM_RefinedMapsTwin(benchmark::State& state) {
  Scene& s = TheScene();
  s.view();
  const ImageView picture = s.scene.picture(0);
  ColorModel colors;
  colors.StartFrom(picture);
  std::vector<PackedScores> scores(static_cast<std::size_t>(picture.width * picture.height));
  for (auto _ : state) {
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const std::uint8_t* p = picture.row(y) + 3 * x;
        scores[static_cast<std::size_t>(y * picture.width + x)] =
            colors.table()[static_cast<std::size_t>(ColorModel::BinOf(p[0], p[1], p[2]))];
      }
    }
    benchmark::DoNotOptimize(NaiveBands(picture));
    benchmark::ClobberMemory();
  }
}
BENCHMARK(BM_RefinedMapsTwin)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace visavis
