// Compares this project's physics with MuJoCo: speed of computing, and speed and torque of the simulated robot.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "bench/engines/engine.hpp"
#include "bench/engines/mujoco_engine.hpp"
#include "bench/engines/tasks.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kPeriod_s = 0.02;

/// [s] processor time of this thread: other programs on the machine disturb it less than the wall clock.
double cpu_time_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Settings {
  std::optional<SolverSettings> world;
  std::optional<MujocoSettings> mujoco;
};

std::unique_ptr<Engine> make_engine(const RobotModel& robot, const Settings& settings, const Motion& motion) {
  if (settings.world) return std::make_unique<WorldEngine>(robot, *settings.world, motion.object());
  return std::make_unique<MujocoEngine>(robot, *settings.mujoco, motion.object());
}

json describe(const Settings& settings) {
  if (settings.world) return {{"engine", settings.world->engine}, {"step_s", settings.world->step_s}};
  const char* const solvers[] = {"PGS", "CG", "Newton"};
  const char* const grounds[] = {"exported", "lasting", "rectangle"};
  return {{"step_s", settings.mujoco->step_s},
          {"iterations", settings.mujoco->iterations},
          {"tolerance", settings.mujoco->tolerance},
          {"solver", solvers[settings.mujoco->solver]},
          {"ground_contact", grounds[static_cast<int>(settings.mujoco->ground)]}};
}

std::unique_ptr<Motion> make_motion(const std::string& name, const RobotModel& robot) {
  if (name == "loaded") return std::make_unique<CarryingGait>(robot);
  return std::make_unique<EmptyGait>(robot);
}

Vector3d centre(const Engine& engine, std::size_t modules) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < modules; ++i) sum += engine.module_position_m(i);
  return sum / static_cast<double>(modules);
}

/// What the robot does in one engine. Torques are means over a tick, of the yaw joints.
json measure(const RobotModel& robot, const std::string& name, const Settings& settings) {
  const auto motion = make_motion(name, robot);
  const auto engine = make_engine(robot, settings, *motion);
  const std::vector<std::size_t> joints = robot.yaw_joints();
  const int first = static_cast<int>(std::lround(motion->settled_s() / kPeriod_s));
  const int ticks = static_cast<int>(std::lround(motion->measured_s() / kPeriod_s));
  Vector3d from = Vector3d::Zero();
  double torque_squares = 0.0;
  double error_squares = 0.0;
  std::vector<double> torques(joints.size());
  int steps = 0;
  for (int tick = 0; tick < first + ticks; ++tick) {
    if (tick == first) from = centre(*engine, robot.module_count);
    const ServoCommand command = motion->command(tick * kPeriod_s, kPeriod_s);
    std::fill(torques.begin(), torques.end(), 0.0);
    steps = 0;
    engine->tick(command, kPeriod_s, [&] {
      for (std::size_t k = 0; k < joints.size(); ++k) torques[k] += engine->step_torque_nm(joints[k]);
      ++steps;
    });
    if (tick < first) continue;
    for (std::size_t k = 0; k < joints.size(); ++k) {
      torque_squares += std::pow(torques[k] / steps, 2);
      error_squares += std::pow(command.position_rad[joints[k]] - engine->joint_angle_rad(joints[k]), 2);
    }
  }
  const double samples = static_cast<double>(ticks) * static_cast<double>(joints.size());
  const Vector3d moved = centre(*engine, robot.module_count) - from;
  json result = {{"settings", describe(settings)},
                 {"speed_m_s", moved.head<2>().norm() / (ticks * kPeriod_s)},
                 {"torque_rms_nm", std::sqrt(torque_squares / samples)},
                 {"tracking_rms_rad", std::sqrt(error_squares / samples)}};
  if (motion->object()) {
    const Vector3d offset = engine->object_position_m() - engine->module_position_m(12);
    result["object_to_base_m"] = offset.head<2>().norm();
  }
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
json study(const RobotModel& robot, const std::string& name, const Settings& production, const Settings& converged) {
  Settings finer = production;
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
json race(const RobotModel& robot, const std::string& name, const Settings& world, const Settings& mujoco) {
  constexpr int kTurn = 25;  // ticks
  struct Runner {
    std::unique_ptr<Motion> motion;
    std::unique_ptr<Engine> engine;
    int tick = 0;
    std::vector<double> ticks_s;
  };
  std::vector<Runner> runners;
  for (const Settings& settings : {world, mujoco}) {
    auto motion = make_motion(name, robot);
    auto engine = make_engine(robot, settings, *motion);
    runners.push_back({std::move(motion), std::move(engine), 0, {}});
  }
  const int first = static_cast<int>(std::lround(runners[0].motion->settled_s() / kPeriod_s));
  const int ticks = static_cast<int>(std::lround(runners[0].motion->measured_s() / kPeriod_s));
  while (runners[0].tick < first + ticks) {
    for (Runner& runner : runners) {
      const bool measured = runner.tick >= first;
      double used_s = 0.0;
      for (int i = 0; i < kTurn; ++i, ++runner.tick) {
        const ServoCommand command = runner.motion->command(runner.tick * kPeriod_s, kPeriod_s);
        const double from_s = cpu_time_s();
        runner.engine->tick(command, kPeriod_s, {});
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

Settings mujoco(GroundContact ground, double step_s) {
  MujocoSettings settings;
  settings.ground = ground;
  settings.step_s = step_s;
  return {{}, settings};
}

json compare(const RobotModel& robot, const std::string& name) {
  // The step of each engine is the largest one whose results differ from the converged ones by a few percent, as those
  // of this project's default settings do.
  const Settings world{SolverSettings{}, {}};
  const auto converged = [](Settings settings) {
    if (settings.world) settings.world->step_s = 0.0005;
    if (settings.mujoco) {
      settings.mujoco->step_s = 0.0005;
      settings.mujoco->iterations = 100;
      settings.mujoco->tolerance = 1e-8;
    }
    return settings;
  };
  json result = {{"constrictor", study(robot, name, world, converged(world))}};
  const std::vector<std::pair<const char*, Settings>> variants = {
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
