// One tick of the component `physics` in one process: physics, noise of sensors, messages, hashes.
#include <benchmark/benchmark.h>

#include "barrier/local_run.hpp"
#include "bench/undulator.hpp"
#include "component/data_path.hpp"
#include "sim/physics/physics.hpp"

namespace constrictor {
namespace {

void plant_tick(benchmark::State& state) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/case_study.yaml");
  LocalRun run({make_physics_factory(), bench::undulator()}, setup);
  run.advance(100);
  for (auto _ : state) run.advance(1);
  state.counters["x_real_time"] =
      benchmark::Counter(0.02 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(plant_tick)->Unit(benchmark::kMillisecond)->Iterations(300);

}  // namespace
}  // namespace constrictor
