// Compares this project's physics with MuJoCo: speed of computing, and speed and torque of the simulated robot.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/engines/engine_run.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using nlohmann::json;

/// [s] processor time of this thread: other programs on the machine disturb it less than the wall clock.
double cpu_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

json describe(const EngineSettings& settings) {
  if (settings.world) return {{"engine", settings.world->engine}, {"step_s", settings.world->step_s}};
  const char* const solvers[] = {"PGS", "CG", "Newton"};
  const char* const grounds[] = {"exported", "lasting", "rectangle"};
  return {{"step_s", settings.mujoco->step_s},
          {"iterations", settings.mujoco->iterations},
          {"tolerance", settings.mujoco->tolerance},
          {"solver", solvers[settings.mujoco->solver]},
          {"ground_contact", grounds[static_cast<int>(settings.mujoco->ground)]}};
}

json measure(const RobotModel& robot, const std::string& name, const EngineSettings& settings) {
  const EngineMeasurement found = measure_engine(robot, name, settings);
  json result = {{"settings", describe(settings)},
                 {"speed_m_s", found.speed_m_s},
                 {"torque_rms_nm", found.torque_rms_nm},
                 {"tracking_rms_rad", found.tracking_rad}};
  if (found.object_to_base_m) result["object_to_base_m"] = *found.object_to_base_m;
  return result;
}

double percent(const json& value, const json& reference, const char* key) {
  return 100.0 * (value[key].get<double>() / reference[key].get<double>() - 1.0);
}

json deviation(const json& value, const json& reference) {
  return {{"speed_percent", percent(value, reference, "speed_m_s")},
          {"torque_percent", percent(value, reference, "torque_rms_nm")}};
}

/// One engine with its production settings, with half the step and twice the iterations, and converged.
json study(const RobotModel& robot, const std::string& name, const EngineSettings& production,
           const EngineSettings& converged) {
  EngineSettings finer = production;
  if (finer.world) finer.world->step_s *= 0.5;
  if (finer.mujoco) finer.mujoco->step_s *= 0.5, finer.mujoco->iterations *= 2;
  json result = {{"production", measure(robot, name, production)},
                 {"half_step_double_iterations", measure(robot, name, finer)},
                 {"converged", measure(robot, name, converged)}};
  result["production_from_converged"] = deviation(result["production"], result["converged"]);
  result["half_step_double_iterations_from_converged"] =
      deviation(result["half_step_double_iterations"], result["converged"]);
  return result;
}

/// Both engines simulate the motion in turns of half a second.
json race(const RobotModel& robot, const std::string& name, const EngineSettings& world, const EngineSettings& mujoco) {
  constexpr int kTurn = 25;  // ticks
  struct Runner {
    std::unique_ptr<Motion> motion;
    std::unique_ptr<Engine> engine;
    int tick = 0;
    std::vector<double> ticks_s;
  };
  std::vector<Runner> runners;
  for (const EngineSettings& settings : {world, mujoco}) {
    auto motion = make_motion(name, robot);
    auto engine = make_engine(robot, settings, *motion);
    runners.push_back({std::move(motion), std::move(engine), 0, {}});
  }
  const int first = static_cast<int>(std::lround(runners[0].motion->settled_s() / kEnginePeriod_s));
  const int ticks = static_cast<int>(std::lround(runners[0].motion->measured_s() / kEnginePeriod_s));
  while (runners[0].tick < first + ticks) {
    for (Runner& runner : runners) {
      const bool measured = runner.tick >= first;
      double used_s = 0.0;
      for (int i = 0; i < kTurn; ++i, ++runner.tick) {
        const ServoCommand command = runner.motion->command(runner.tick * kEnginePeriod_s, kEnginePeriod_s);
        const double from_s = cpu_time_s();
        runner.engine->tick(command, kEnginePeriod_s, {});
        used_s += cpu_time_s() - from_s;
      }
      if (measured) runner.ticks_s.push_back(kTurn / used_s);
    }
  }
  std::vector<double> ratios;
  for (std::size_t i = 0; i < runners[0].ticks_s.size(); ++i)
    ratios.push_back(runners[0].ticks_s[i] / runners[1].ticks_s[i]);
  const auto quantile = [](std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  return {
      {"turns", ratios.size()},
      {"ticks_per_s",
       {{"constrictor", quantile(runners[0].ticks_s, 0.5)}, {"mujoco", quantile(runners[1].ticks_s, 0.5)}}},
      {"constrictor_per_mujoco",
       {{"median", quantile(ratios, 0.5)}, {"tenth", quantile(ratios, 0.1)}, {"ninetieth", quantile(ratios, 0.9)}}}};
}

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

EngineSettings mujoco(GroundContact ground, double step_s) {
  MujocoSettings settings;
  settings.ground = ground;
  settings.step_s = step_s;
  return {{}, settings};
}

json compare(const RobotModel& robot, const std::string& name) {
  // The step of each engine is the largest one whose results differ from the converged ones by a few percent, as those
  // of this project's default settings do.
  const EngineSettings world{SolverSettings{}, {}};
  json result = {{"constrictor", study(robot, name, world, converged(world))}};
  const std::vector<std::pair<const char*, EngineSettings>> variants = {
      {"mujoco_exported", mujoco(GroundContact::kExported, 0.002)},
      {"mujoco_lasting", mujoco(GroundContact::kLasting, 0.004)},
      {"mujoco_rectangle", mujoco(GroundContact::kRectangle, 0.00125)}};
  for (const auto& [variant, settings] : variants) {
    result[variant] = study(robot, name, settings, converged(settings));
    result[variant]["converged_from_constrictor"] =
        deviation(result[variant]["converged"], result["constrictor"]["converged"]);
    result[variant]["race"] = race(robot, name, world, settings);
  }
  return result;
}

}  // namespace
}  // namespace constrictor

int main(int argc, char** argv) {
  const std::vector<std::string> names(argv + 1, argv + argc);
  for (const std::string& name : names) {
    if (name == "empty" || name == "loaded") continue;
    fmt::print(stderr, "bench_engines: found '{}', accepted empty and loaded\n", name);
    return 64;
  }
  try {
    const auto robot = constrictor::load_robot(constrictor::testing::robot_path("mamba"));
    nlohmann::json result = {{"processor", constrictor::processor()}, {"mujoco_version", mj_versionString()}};
    for (const char* name : {"empty", "loaded"}) {
      if (names.empty() || std::count(names.begin(), names.end(), name) > 0)
        result[name] = constrictor::compare(robot, name);
    }
    fmt::print("{}\n", result.dump(2));
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_engines: {}\n", error.what());
    return 1;
  }
  return 0;
}
