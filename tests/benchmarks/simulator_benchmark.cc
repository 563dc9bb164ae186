// Time of a stereo pair of 640 x 480 RGB with noise on one core; the simulator must make 30 a
// second.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "common/rigs/demo_rig.h"
#include "services/simulator/simulated_world.h"

namespace visavis {
namespace {

struct Setting {
  const char* label;
  const char* scenario;
  const char* subject;
  int blur_samples;
};

constexpr Setting kSettings[] = {{"shuttle_x, short hair", "shuttle_x", "adult_a", 1},
                                 {"shuttle_x, long hair", "shuttle_x", "adult_b", 1},
                                 {"moving head", "moving_head", "adult_a", 1},
                                 {"shuttle_x, blur of 4", "shuttle_x", "adult_a", 4}};

void Pair(benchmark::State& state) {
  const Setting& setting = kSettings[state.range(0)];
  ScenarioConfig scenario;
  scenario.name = setting.scenario;
  SceneConfig scene;
  scene.subject = setting.subject;
  SensorConfig sensor;
  sensor.blur_samples = setting.blur_samples;
  SimulatedWorld world(scenario, scene, sensor, DemoRig().rig, DemoCameraPose(), 1);
  std::vector<std::uint8_t> right(640 * 480 * 3), left = right;
  std::int64_t frame = 0;
  double face = 0;
  for (auto _ : state) {
    const double t = static_cast<double>(frame) / 30;
    const auto truth =
        world.Render(t, frame, [&](double s) { return world.scenario().CameraPose(s); },
                     {right.data(), 640, 480, 1920}, {left.data(), 640, 480, 1920});
    face = truth.face_visible_share;
    ++frame;
  }
  if (face < 0.9) state.SkipWithError("the face is not in the picture");
  state.SetLabel(setting.label);
  state.counters["pairs_per_s"] =
      benchmark::Counter(static_cast<double>(frame), benchmark::Counter::kIsRate);
}
BENCHMARK(Pair)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

void StartUp(benchmark::State& state) {
  for (auto _ : state) {
    const SimulatedWorld world({}, {}, {}, DemoRig().rig, DemoCameraPose(), 1);
    benchmark::DoNotOptimize(&world);
  }
}
BENCHMARK(StartUp)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace visavis
