// Benchmarks of the recogniser's parts. Each checks what it timed, and prints its naive twin or its
// peer beside it: compare rows of one run, never seconds of different runs.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "common/core/clock.h"
#include "services/recogniser/published_estimator.h"
#include "tests/support/naive_fitness.h"
#include "tests/support/painted_head.h"

namespace visavis {
namespace {

struct Scene {
  Scene() {
    phi << 0.02, -0.01, 1.02, 0.1, -0.1, 0.05;
    const RigidTransform X_CM = TransformFromPhi(phi);
    right_image = right_painter.Paint(X_CM);
    left_image = left_painter.Paint(rig.X_CL.inverse() * X_CM);
    right.Build(right_image, color);
    left.Build(left_image, color);
    Random random(7);
    for (Vector6d& near : phis) {
      for (int k = 0; k < 6; ++k) near[k] = phi[k] + (k < 3 ? 0.03 : 0.1) * random.Normal();
    }
  }
  HeadModelConfig head;
  ColorRuleConfig color;
  StereoRig rig = TestRig();
  PaintedHead right_painter{head, rig.right}, left_painter{head, rig.left};
  ImageView right_image, left_image;
  PackedMap right{640, 480}, left{640, 480};
  Vector6d phi;
  std::array<Vector6d, 60> phis;
};

Scene& TheScene() {
  static Scene scene;
  return scene;
}

void CountPoints(benchmark::State& state, int points) {
  state.SetItemsProcessed(state.iterations() * points);
  state.counters["ns_per_point"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * points * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["points"] = points;
}

void BM_FitnessKernel(benchmark::State& state) {
  Scene& s = TheScene();
  const StereoFitness fitness(HeadModel(s.head), s.rig, {});
  const NaiveFitness naive(fitness.model(), s.rig, s.color);
  std::size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    sum += fitness.Evaluate({&s.right, &s.left}, s.phis[i]).total;
    i = (i + 1) % s.phis.size();
  }
  benchmark::DoNotOptimize(sum);
  CountPoints(state, fitness.num_points());
  const double error = fitness.Evaluate({&s.right, &s.left}, s.phi).total -
                       naive.Evaluate(s.right_image, s.left_image, s.phi).total;
  if (std::abs(error) > 0.01) state.SkipWithError("kernel and twin differ");
}
BENCHMARK(BM_FitnessKernel);

void BM_FitnessNaiveTwin(benchmark::State& state) {
  Scene& s = TheScene();
  const HeadModel model(s.head);
  const NaiveFitness naive(model, s.rig, s.color);
  std::size_t i = 0;
  double sum = 0;
  for (auto _ : state) {
    sum += naive.Evaluate(s.right_image, s.left_image, s.phis[i]).total;
    i = (i + 1) % s.phis.size();
  }
  benchmark::DoNotOptimize(sum);
  CountPoints(state, 2 * model.num_points());
}
BENCHMARK(BM_FitnessNaiveTwin);

void BM_PackedMapPair(benchmark::State& state) {
  Scene& s = TheScene();
  for (auto _ : state) {
    s.right.Build(s.right_image, s.color);
    s.left.Build(s.left_image, s.color);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * 2 * 640 * 480);
}
BENCHMARK(BM_PackedMapPair)->Unit(benchmark::kMicrosecond);

// 300 generations of 60 individuals on one pair.
void BM_300GenerationsOf60(benchmark::State& state) {
  Scene& s = TheScene();
  PublishedEstimator::Settings settings;
  settings.space = SearchSpace::FromConfig({});
  settings.published.generations_per_frame = 300;
  PublishedEstimator estimator(settings, s.head, s.rig);
  StageTimer timer(&MonotonicSeconds);
  const StereoFrame frame{0, s.right_image, s.left_image};
  timer.Restart();
  for (auto _ : state) {
    const Estimate& estimate = estimator.Process(frame, {}, &timer);
    if (estimate.generations != 300) state.SkipWithError("wrong number of generations");
  }
  state.SetItemsProcessed(state.iterations() * 300);
}
BENCHMARK(BM_300GenerationsOf60)->Unit(benchmark::kMillisecond);

// What the engine costs beside the fitness: one generation of 60 on a fitness that costs nothing.
void BM_GaEngineGeneration(benchmark::State& state) {
  GeneticAlgorithm ga({}, SearchSpace::FromConfig({}), 1);
  const auto fitness = [](const Vector6d& phi) { return -phi.squaredNorm(); };
  ga.Evaluate(fitness);
  for (auto _ : state) {
    ga.Reproduce();
    ga.Evaluate(fitness);
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BM_GaEngineGeneration)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace visavis
