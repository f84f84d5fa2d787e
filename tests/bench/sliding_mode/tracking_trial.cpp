#include "bench/sliding_mode/tracking_trial.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "bench/method_driver.hpp"
#include "sim/world/world.hpp"

namespace constrictor::sliding_mode {
namespace {

constexpr unsigned kSeed = 20261123;

double heading_of(const World& world) {
  const Eigen::Vector3d axis =
      world.module_pose(0).translation() - world.module_pose(world.module_count() - 1).translation();
  return std::atan2(axis.y(), axis.x());
}

double rms(const std::vector<double>& values, bool about_mean) {
  double mean = 0.0, squares = 0.0;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) mean += about_mean ? value / count : 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean) / count;
  return std::sqrt(squares);
}

}  // namespace

Tracking run(const RobotModel& robot, const Trial& trial) {
  Scenario scenario;
  scenario.friction.ground_scale = trial.friction_share;
  scenario.body.mass_scale = trial.mass_share;
  SolverSettings settings;  // whole steps make a tick
  settings.step_s = trial.period_s / std::ceil(trial.period_s / settings.step_s - 1e-9);
  World world(robot, scenario, settings);
  MethodDriver driver(robot, {trial.method, trial.config, trial.period_s, trial.frequency_hz, trial.curvature_1_m});
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0.0, robot.joint_position_noise_rad);
  const std::size_t n = robot.joints.size(), middle = n / 4 * 2;
  const auto yaw = robot.yaw_joints();
  std::vector<JointSetpoint> next;
  std::vector<double> errors, torques, headings;
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Tracking found;
  const auto ticks = static_cast<int>(std::lround(trial.duration_s / trial.period_s));
  const auto settle = static_cast<int>(std::lround(kSettle_s / trial.period_s));
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == settle) from_m = world.module_pose(n / 2).translation();
    JointArray angle{}, rate{};
    for (std::size_t j = 0; j < n; ++j) {
      angle[j] = world.joint_angle_rad(j) + noise(random);
      rate[j] = world.joint_rate_rad_s(j);
    }
    const JointArray before = driver.wanted_rad();  // acts until the end of this tick
    const std::vector<JointSetpoint> later = driver.step(angle, rate);
    if (!next.empty()) world.set_servo(next);
    next = later;
    world.advance(trial.period_s, [&] {
      if (tick < settle) return;
      for (std::size_t j = 0; j < n; ++j) {
        const double torque_nm = world.joint(j).step_torque_nm();
        torques.push_back(torque_nm);
        found.power_w += std::max(0.0, torque_nm * world.joint_rate_rad_s(j));
      }
    });
    if (tick < settle) continue;
    for (const std::size_t j : yaw) errors.push_back(world.joint_angle_rad(j) - before[j]);
    headings.push_back(heading_of(world));
    for (std::size_t module = 0; module < world.module_count(); ++module) {
      const double above_m = world.module_pose(module).translation().z() - robot.module_radius_m;
      found.raised_m = std::max(found.raised_m, above_m);
    }
    found.course.push_back({(tick + 1) * trial.period_s, before[middle], world.joint_angle_rad(middle)});
  }
  found.error_rad = rms(errors, false);
  found.heading_rad = rms(headings, true);
  found.torque_nm = rms(torques, false);
  found.power_w *= static_cast<double>(n) / static_cast<double>(torques.size());
  found.speed_m_s = (world.module_pose(n / 2).translation() - from_m).norm() / ((ticks - settle) * trial.period_s);
  return found;
}

}  // namespace constrictor::sliding_mode
