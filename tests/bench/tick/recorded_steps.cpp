#include "bench/tick/recorded_steps.hpp"

#include <algorithm>
#include <chrono>

#include "component/data_path.hpp"
#include "configuration/quantiles.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "sim/world/ground_torques.hpp"
#include "sim/world/mechanism.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor::bench {
namespace {

constexpr double kPeriod_s = 0.02;
constexpr int kFirstTick = 100;     // the gait has settled
constexpr int kRecordedTicks = 96;  // 1.3 cycles of the gait
constexpr int kRepetitions = 5;     // of a measurement

/// [s] Not the processor time of the thread: reading that is a system call, after which the processor has forgotten the
/// branches of the code, so that each part would seem to take a microsecond longer.
double wall_time_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// [s] what an empty measurement shows: the time to read the clock.
double clock_s() {
  static const double found = [] {
    std::vector<double> differences;
    for (int i = 0; i < 2001; ++i) {
      const double from_s = wall_time_s();
      differences.push_back(wall_time_s() - from_s);
    }
    return interpolated_quantile(differences, 0.5);
  }();
  return found;
}

}  // namespace

Scenario case_study_scene(const RobotModel& robot) {
  return load_scenario(data_path("sim/scenarios/case_study.yaml"), 1,
                       static_cast<double>(robot.module_count) * robot.module_length_m, robot.module_radius_m);
}

void RecordedStep::begin(ChainDynamics& engine) {
  engine.load(before_);
  drives_ = recorded_drives_;
  rows_.resize(drives_.size());
  contacts_.begin_tick();
}

void RecordedStep::run_until(Part end, const World& world, ContactFinder& finder, ChainDynamics& engine) {
  for (auto part = Part::kServos; part < end; part = static_cast<Part>(static_cast<int>(part) + 1))
    run(part, world, finder, engine);
}

void RecordedStep::run(Part part, const World& world, ContactFinder& finder, ChainDynamics& engine) {
  const SolverSettings settings;
  switch (part) {
    case Part::kServos:
      for (std::size_t i = 0; i < drives_.size(); ++i) rows_[i] = drives_[i].drive();
      return;
    case Part::kGroundTorques:
      stand_on_bellies(world.robot(), world.scenario(), engine);
      resist_rolling(world.scenario(), world.module_count(), settings.step_s, engine);
      return;
    case Part::kCollision:
      contacts_.begin_step();
      return finder.find(engine, contacts_);
    case Part::kBuilding:
      return engine.prepare(rows_, contacts_.contacts());
    case Part::kSolution:
      return engine.solve(contacts_.contacts());
    case Part::kIntegration:
      return engine.finish(contacts_.contacts());
    case Part::kContactSums:
      contacts_.collect(engine);
      for (std::size_t i = 0; i < drives_.size(); ++i)
        drives_[i].measure(engine.angle_rad(i), engine.rate_rad_s(i), engine.torque_nm(i), settings.step_s,
                           world.robot().torque_filter_s);
      return;
    case Part::kEnd:
      return;
  }
}

RecordedTicks::RecordedTicks()
    : robot_(load_robot(data_path("components/lib/robot/mamba.yaml"))),
      world_(robot_, case_study_scene(robot_)),
      finder_(world_.robot(), world_.scenario(), SolverSettings{}),
      engine_(mechanism_of(world_.robot(), world_.scenario()), SolverSettings{}) {
  const OpenLoopGait gait;
  const auto drives = [this] {
    std::vector<JointDrive> copies;
    for (std::size_t i = 0; i < world_.joint_count(); ++i) copies.push_back(world_.joint(i));
    return copies;
  };
  for (int tick = 0; tick < kFirstTick; ++tick) gait.drive(world_, tick * kPeriod_s, kPeriod_s);
  for (int tick = kFirstTick; tick < kFirstTick + kRecordedTicks; ++tick) {
    gait.command(world_, tick * kPeriod_s, kPeriod_s);
    std::vector<double> before = world_.dynamics().save();
    std::vector<JointDrive> drives_before = drives();
    for (JointDrive& drive : drives_before) drive.begin_tick(kSteps, SolverSettings{}.step_s);
    world_.advance(kPeriod_s, [&] {
      std::vector<double> after = world_.dynamics().save();
      steps_.emplace_back(std::move(before), std::move(drives_before), after);
      before = std::move(after);
      drives_before = drives();
    });
  }
}

double RecordedTicks::run(std::size_t tick, Part part) {
  double used_s = 0.0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    RecordedStep& step = steps_[kSteps * tick + i];
    step.begin(engine_);
    step.run_until(part, world_, finder_, engine_);
    const double from_s = wall_time_s();
    step.run(part, world_, finder_, engine_);
    used_s += wall_time_s() - from_s - clock_s();
  }
  return std::max(0.0, used_s);
}

double RecordedTicks::measure(std::size_t tick, Part part) {
  std::vector<double> found_s;
  for (int i = 0; i < kRepetitions; ++i) found_s.push_back(run(tick, part));
  return interpolated_quantile(found_s, 0.5);
}

bool RecordedTicks::exact() {
  for (RecordedStep& step : steps_) {
    step.begin(engine_);
    step.run_until(Part::kEnd, world_, finder_, engine_);
    if (!step.same_end(engine_)) return false;
  }
  return true;
}

double RecordedTicks::iterations_per_tick() {
  const std::int64_t before = engine_.iterations();
  for (std::size_t tick = 0; tick < size(); ++tick) run(tick, Part::kEnd);
  return static_cast<double>(engine_.iterations() - before) / static_cast<double>(size());
}

}  // namespace constrictor::bench
