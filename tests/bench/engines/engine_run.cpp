#include "bench/engines/engine_run.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace constrictor {
namespace {

using Eigen::Vector3d;

Vector3d centre(const Engine& engine, std::size_t modules) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < modules; ++i) sum += engine.module_position_m(i);
  return sum / static_cast<double>(modules);
}

}  // namespace

EngineSettings converged(EngineSettings settings) {
  if (settings.world) settings.world->step_s = 0.0005;
  if (settings.mujoco) {
    settings.mujoco->step_s = 0.0005;
    settings.mujoco->iterations = 100;
    settings.mujoco->tolerance = 1e-8;
  }
  return settings;
}

std::unique_ptr<Engine> make_engine(const RobotModel& robot, const EngineSettings& settings, const Motion& motion) {
  if (settings.world) return std::make_unique<WorldEngine>(robot, *settings.world, motion.object());
  return std::make_unique<MujocoEngine>(robot, *settings.mujoco, motion.object());
}

std::unique_ptr<Motion> make_motion(const std::string& name, const RobotModel& robot) {
  if (name == "loaded") return std::make_unique<CarryingGait>(robot);
  return std::make_unique<EmptyGait>(robot);
}

EngineMeasurement measure_engine(const RobotModel& robot, const std::string& name, const EngineSettings& settings) {
  const auto motion = make_motion(name, robot);
  const auto engine = make_engine(robot, settings, *motion);
  const std::vector<std::size_t> joints = robot.yaw_joints();
  const int first = static_cast<int>(std::lround(motion->settled_s() / kEnginePeriod_s));
  const int ticks = static_cast<int>(std::lround(motion->measured_s() / kEnginePeriod_s));
  Vector3d from = Vector3d::Zero();
  double torque_squares = 0.0;
  double error_squares = 0.0;
  std::vector<double> torques(joints.size());
  int steps = 0;
  for (int tick = 0; tick < first + ticks; ++tick) {
    if (tick == first) from = centre(*engine, robot.module_count);
    const ServoCommand command = motion->command(tick * kEnginePeriod_s, kEnginePeriod_s);
    std::fill(torques.begin(), torques.end(), 0.0);
    steps = 0;
    engine->tick(command, kEnginePeriod_s, [&] {
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
  EngineMeasurement found;
  found.speed_m_s = moved.head<2>().norm() / (ticks * kEnginePeriod_s);
  found.torque_rms_nm = std::sqrt(torque_squares / samples);
  found.tracking_rad = std::sqrt(error_squares / samples);
  if (motion->object()) {
    const Vector3d offset = engine->object_position_m() - engine->module_position_m(12);
    found.object_to_base_m = offset.head<2>().norm();
  }
  return found;
}

}  // namespace constrictor
