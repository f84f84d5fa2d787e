// What the parts of a tick cost. The parts of the physics are those of World::step, on steps that a world has really
// done; the parts of the plant are what the component `physics` and the barrier add. bench_table compares the sums with
// the whole ticks.
#include <benchmark/benchmark.h>

#include <cmath>

#include "barrier/local_run.hpp"
#include "bench/tick/recorded_steps.hpp"
#include "bench/undulator.hpp"
#include "component/data_path.hpp"
#include "runtime/checkpoint_file.hpp"
#include "sim/physics/physics.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

using bench::Part;
using bench::RecordedTicks;

constexpr double kPeriod_s = 0.02;

RecordedTicks& recorded() {
  static RecordedTicks ticks;
  return ticks;
}

/// Refuses to measure parts that are no longer those of World::step.
bool refused(benchmark::State& state) {
  static const bool exact = recorded().exact();
  if (!exact) state.SkipWithError("the parts have another result than World::step: change RecordedStep::run as well");
  return !exact;
}

/// One part in all steps of a tick.
void part(benchmark::State& state, Part part) {
  if (refused(state)) return;
  std::size_t tick = 0;
  for (auto _ : state) {
    state.SetIterationTime(recorded().measure(tick, part));
    tick = (tick + 1) % recorded().size();
  }
}
#define PART(name, part_of_step)              \
  BENCHMARK_CAPTURE(part, name, part_of_step) \
      ->Name("physics_part/" #name)           \
      ->UseManualTime()                       \
      ->Iterations(288)                       \
      ->Unit(benchmark::kMillisecond)
PART(servos, Part::kServos);
PART(ground_torques, Part::kGroundTorques);
PART(collision, Part::kCollision);
PART(building_the_system, Part::kBuilding);
PART(solution, Part::kSolution);
PART(integration, Part::kIntegration);
PART(felt_contacts, Part::kContactSums);
#undef PART

/// The part of the solution that eliminates the joints, and solves with the result: as often as in the mean tick. Its
/// time does not depend on the numbers.
void factorisation(benchmark::State& state) {
  if (refused(state)) return;
  const auto modules = recorded().world().module_count();
  const auto iterations = static_cast<int>(std::lround(recorded().iterations_per_tick()));
  std::vector<Matrix6d> stiffness(modules, Matrix6d::Identity());
  std::vector<ChainFactor::Joint> joints(modules - 1, {Vector6d::LinSpaced(0.5, 1.0), 1.0});
  Eigen::VectorXd unknowns(static_cast<Eigen::Index>(modules) + 5);
  ChainFactor factor;
  for (auto _ : state) {
    for (int i = 0; i < iterations; ++i) {
      factor.compute(stiffness, joints);
      unknowns.setOnes();
      factor.solve(unknowns);
    }
    benchmark::DoNotOptimize(unknowns.data());
  }
  state.counters["iterations_per_tick"] = iterations;
}
BENCHMARK(factorisation)->Name("physics_part/factorisation")->Unit(benchmark::kMillisecond);

/// The state hash of a tick; its time depends only on the number of values.
void state_hash(benchmark::State& state) {
  const World& world = recorded().world();
  std::vector<double> values(13 * (world.module_count() + world.object_count()) + 2 * world.joint_count(), 0.5);
  StateHash hash;
  for (auto _ : state) hash.extend(values);
}
BENCHMARK(state_hash)->Name("physics_part/state_hash")->Unit(benchmark::kMillisecond);

/// A whole tick of the physics.
void physics_tick(benchmark::State& state) {
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  World world(robot, bench::case_study_scene(robot));
  const OpenLoopGait gait;
  int tick = 0;
  for (; tick < 100; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
  for (auto _ : state) gait.drive(world, tick++ * kPeriod_s, kPeriod_s);
}
BENCHMARK(physics_tick)->Name("whole_tick/physics")->Unit(benchmark::kMillisecond)->Iterations(500);

Setup setup() {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/case_study.yaml");
  return setup;
}

/// The component `physics` and a gait in place of `control`, in one process.
std::unique_ptr<LocalRun> gait_run() {
  auto run = std::make_unique<LocalRun>(std::vector{make_physics_factory(), bench::undulator()}, setup());
  run->advance(100);
  return run;
}

void plant_tick(benchmark::State& state) {
  const auto run = gait_run();
  for (auto _ : state) run->advance(1);
}
BENCHMARK(plant_tick)->Name("whole_tick/plant")->Unit(benchmark::kMillisecond)->Iterations(500);

/// All readings of the sensors with their noise, and the true state of the world.
void sensors(benchmark::State& state) {
  const World& world = recorded().world();
  Sensors sensors(world.robot(), 1, true);
  msg::ContactState felt{};
  msg::TouchedState touched{};
  for (auto _ : state) {
    benchmark::DoNotOptimize(sensors.joints(world));
    sensors.contacts(world, felt, touched);
    benchmark::DoNotOptimize(felt);
    benchmark::DoNotOptimize(sensors.imu(world, kPeriod_s));
    benchmark::DoNotOptimize(world_state(world));
  }
}
BENCHMARK(sensors)->Name("plant_part/sensors")->Unit(benchmark::kMillisecond);

/// The commands of a tick: the gait that stands for `control`.
void gait(benchmark::State& state) {
  const OpenLoopGait gait;
  double time_s = 2.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(gait.angles(recorded().world().robot(), time_s));
    benchmark::DoNotOptimize(gait.angles(recorded().world().robot(), time_s += kPeriod_s));
  }
}
BENCHMARK(gait)->Name("plant_part/gait")->Unit(benchmark::kMillisecond);

/// The barrier and the messages of a tick, without the components: a plant and a member write the same messages as
/// above. Each is checked, copied, converted into bytes, hashed, delivered, and kept for a restart.
void messages(benchmark::State& state) {
  const auto source = gait_run();
  const auto plant = [&source](Wiring& wiring) -> testing::StepFunction {
    static_cast<void>(wiring.latest(topics::kJointCommand));
    return [joints = wiring.output(topics::kJointState), contacts = wiring.output(topics::kContactState),
            touched = wiring.output(topics::kTouchedState), imu = wiring.output(topics::kImuState),
            world = wiring.output(topics::kWorldState), &source](const Tick&) {
      joints.write(*source->latest(topics::kJointState));
      contacts.write(*source->latest(topics::kContactState));
      touched.write(*source->latest(topics::kTouchedState));
      imu.write(*source->latest(topics::kImuState));
      world.write(*source->latest(topics::kWorldState));
    };
  };
  const auto control = [&source](const Tick&, const Output<msg::JointCommand>& output) {
    output.write(*source->latest(topics::kJointCommand));
  };
  LocalRun run({testing::scripted_plant(plant),
                testing::scripted_writer<msg::JointCommand>("control", topics::kJointCommand, control)},
               setup());
  run.advance(100);
  for (auto _ : state) run.advance(1);
}
BENCHMARK(messages)->Name("plant_part/messages_and_barrier")->Unit(benchmark::kMillisecond)->Iterations(2000);

/// The plant's state as bytes, from which a restarted process continues.
void checkpoint(benchmark::State& state) {
  const auto run = gait_run();
  const Component& physics = run->component("physics");
  for (auto _ : state) benchmark::DoNotOptimize(physics.save());
}
BENCHMARK(checkpoint)->Name("plant_part/checkpoint")->Unit(benchmark::kMillisecond);

/// What the plant's process stores before each tick, which a run in one process does not do.
void stored_checkpoint(benchmark::State& state) {
  const testing::TemporaryFolder folder;
  CheckpointFile file(folder.path() / "checkpoint.bin");
  const auto run = gait_run();
  for (auto _ : state) {
    state.PauseTiming();
    run->advance(1);
    state.ResumeTiming();
    file.write(run->checkpoint());
  }
}
BENCHMARK(stored_checkpoint)->Name("process_part/stored_checkpoint")->Unit(benchmark::kMillisecond)->Iterations(500);

}  // namespace
}  // namespace constrictor
