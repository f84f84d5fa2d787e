// One tick of the component `physics` in one process: physics, noise of sensors, messages, hashes.
#include <benchmark/benchmark.h>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "sim/physics/physics.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {
namespace {

/// Replaces the component `control` by the open-loop gait.
class Undulator final : public Component {
 public:
  Undulator(Wiring& wiring, const Setup& setup)
      : robot_(load_robot(setup.robot_file)), output_(wiring.output(topics::kJointCommand)) {}
  void step(const Tick& tick) override {
    msg::JointCommand command{};
    const std::vector<double> angles = gait_.angles(robot_, tick.time_s());
    const std::vector<double> next = gait_.angles(robot_, tick.time_s() + tick.period_s());
    command.joint_count = static_cast<std::uint16_t>(angles.size());
    for (std::size_t i = 0; i < angles.size(); ++i) {
      command.position_rad[i] = angles[i];
      command.velocity_rad_s[i] = (next[i] - angles[i]) / tick.period_s();
      command.torque_limit_nm[i] = robot_.joints[i].max_torque_nm;
    }
    output_.write(command);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  RobotModel robot_;
  OpenLoopGait gait_;
  Output<msg::JointCommand> output_;
};

void plant_tick(benchmark::State& state) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/case_study.yaml");
  const ComponentFactory control{"control",
                                 [](Wiring& wiring, const Setup& s) { return std::make_unique<Undulator>(wiring, s); }};
  LocalRun run({make_physics_factory(), control}, setup);
  run.advance(100);
  for (auto _ : state) run.advance(1);
  state.counters["x_real_time"] =
      benchmark::Counter(0.02 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(plant_tick)->Unit(benchmark::kMillisecond)->Iterations(300);

}  // namespace
}  // namespace constrictor
