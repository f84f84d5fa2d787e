// One control period (20 ms) of the physics. The real-time factor is 20 ms divided by the time of an iteration.
#include <benchmark/benchmark.h>

#include "support/project.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {
namespace {

constexpr double kPeriod_s = 0.02;

/// The gait on flat ground. Arguments: engine (0: ode, 1: chain), step [us], iterations of QuickStep, ground contacts
/// at each joint.
void undulate(benchmark::State& state) {
  SolverSettings settings;
  settings.engine = state.range(0) == 1 ? kEngineChain : kEngineOde;
  settings.step_s = 1e-6 * static_cast<double>(state.range(1));
  settings.iterations = static_cast<int>(state.range(2));
  settings.one_ground_contact_a_joint = state.range(3) == 1;
  World world(load_robot(testing::robot_path("mamba")), Scenario{}, settings);
  OpenLoopGait gait;
  int tick = 0;
  const auto centre_x = [&] { return world.module_pose(12).translation().x(); };
  for (; tick < 100; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
  const double from = centre_x();
  const int first = tick;
  while (state.KeepRunning()) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    ++tick;
  }
  state.counters["x_real_time"] = benchmark::Counter(kPeriod_s * (tick - first), benchmark::Counter::kIsRate);
  state.counters["speed_m_s"] = (centre_x() - from) / (kPeriod_s * (tick - first));
}
BENCHMARK(undulate)
    ->ArgNames({"engine", "step_us", "iterations", "contacts"})
    ->Args({0, 2000, 50, 2})
    ->Args({0, 2000, 20, 2})
    ->Args({0, 4000, 50, 2})
    ->Args({0, 4000, 50, 1})
    ->Args({0, 4000, 20, 2})
    ->Args({0, 1000, 500, 2})
    ->Args({1, 10000, 50, 2})
    ->Args({1, 5000, 50, 2})
    ->Args({1, 4000, 50, 2})
    ->Args({1, 5000, 50, 1})
    ->Args({1, 2000, 50, 2})
    ->Args({1, 500, 50, 2})
    ->Unit(benchmark::kMillisecond)
    ->Iterations(430);  // six cycles of the gait

}  // namespace
}  // namespace constrictor
