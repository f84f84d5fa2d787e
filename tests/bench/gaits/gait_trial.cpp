#include "bench/gaits/gait_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "bench/method_driver.hpp"
#include "sim/world/world.hpp"

namespace constrictor::gaits {
namespace {

using Eigen::Vector2d;

constexpr double kPeriod_s = 0.02;
constexpr double kGravity_m_s2 = 9.81;

Vector2d module_m(const World& world, std::size_t module) { return world.module_pose(module).translation().head<2>(); }

Outline outline_of(const World& world, double time_s) {
  Outline outline{time_s, {}};
  for (std::size_t i = 0; i < world.module_count(); ++i) outline.modules_m.push_back(module_m(world, i));
  return outline;
}

Vector2d centre_of(const Outline& body) {
  return std::accumulate(body.modules_m.begin(), body.modules_m.end(), Vector2d(0.0, 0.0)) /
         static_cast<double>(body.modules_m.size());
}

/// Of the line from tail to head.
double direction_of(const World& world) {
  const Vector2d axis = module_m(world, 0) - module_m(world, world.module_count() - 1);
  return std::atan2(axis.y(), axis.x());
}

Scenario scene_of(const Trial& trial) {
  constexpr double kWall_m = 0.05;
  constexpr double kHeight_m = 0.15;
  constexpr double kLength_m = 12.0;
  Scenario scene;
  if (trial.channel_m <= 0.0) return scene;
  for (const double side : {-1.0, 1.0}) {
    ScenarioObstacle wall;
    wall.shape = BodyShape::kBox;
    wall.size_m = {kLength_m, kWall_m, kHeight_m};
    wall.position_m = {0.0, side * 0.5 * (trial.channel_m + kWall_m)};
    scene.obstacles.push_back(wall);
  }
  return scene;
}

void drive(World& world, MethodDriver& driver) {
  JointArray angle_rad{}, rate_rad_s{};
  for (std::size_t j = 0; j < world.joint_count(); ++j) {
    angle_rad[j] = world.joint_angle_rad(j);
    rate_rad_s[j] = world.joint_rate_rad_s(j);
  }
  world.set_servo(driver.step(angle_rad, rate_rad_s));
  world.advance(kPeriod_s);
}

}  // namespace

Course run(const RobotModel& robot_of_file, const Trial& trial) {
  RobotModel robot = robot_of_file;
  if (trial.friction) robot.friction_along = robot.friction_across = *trial.friction;
  World world(robot, scene_of(trial));
  MethodDriver driver(robot, {trial.method, trial.config, kPeriod_s, trial.frequency_hz, trial.curvature_1_m});
  const double gait_s = std::max(1.0 / std::abs(trial.frequency_hz), kPeriod_s);
  const auto settle = static_cast<int>(std::lround(kSettle_s / kPeriod_s));
  // Whole periods of the gait, so that its own to and fro does not count.
  const double measured_s = gait_s * std::max(1.0, std::floor((trial.duration_s - kSettle_s) / gait_s + 1e-9));
  const auto end = settle + static_cast<int>(std::lround(measured_s / kPeriod_s));
  Course course;
  course.outlines.push_back(outline_of(world, 0.0));
  Vector2d from_m = Vector2d::Zero();
  double from_rad = 0.0;
  double direction_rad = 0.0;
  double turned_rad = 0.0;
  double work_j = 0.0;
  for (int tick = 0; tick < end; ++tick) {
    if (tick == settle) {
      from_m = centre_of(outline_of(world, tick * kPeriod_s));
      from_rad = direction_rad = direction_of(world);
    }
    drive(world, driver);
    if (tick >= settle) {
      const double before_rad = std::exchange(direction_rad, direction_of(world));
      turned_rad += std::remainder(direction_rad - before_rad, 2.0 * std::numbers::pi);
      for (std::size_t j = 0; j < world.joint_count(); ++j) {
        const double torque_nm = world.joint_torque_nm(j);
        work_j += std::max(0.0, torque_nm * world.joint_rate_rad_s(j)) * kPeriod_s;
        course.largest_torque_nm = std::max(course.largest_torque_nm, std::abs(torque_nm));
      }
    }
    if (tick + 1 == end / 2 || tick + 1 == end) course.outlines.push_back(outline_of(world, (tick + 1) * kPeriod_s));
  }
  const Vector2d moved = centre_of(course.outlines.back()) - from_m;
  const Vector2d forward(std::cos(from_rad), std::sin(from_rad));
  const double duration_s = (end - settle) * kPeriod_s;
  course.forward_m_s = moved.dot(forward) / duration_s;
  course.left_m_s = (forward.x() * moved.y() - forward.y() * moved.x()) / duration_s;
  course.turn_rad_s = turned_rad / duration_s;
  const double weight_n = kGravity_m_s2 * robot.module_mass_kg * static_cast<double>(robot.module_count);
  course.transport = work_j / (weight_n * moved.norm());
  return course;
}

double sidewinding_without_slip_m_s(const RobotModel& robot, const ControlConfig& config, double frequency_hz) {
  const double link_m = YawChain(robot).link_length_m();
  const double wavelength_m = config.sidewinding_wavelength_m;
  const double heading_rad = config.sidewinding_yaw_rad / (2.0 * std::sin(std::numbers::pi * link_m / wavelength_m));
  return frequency_hz * wavelength_m * std::sin(heading_rad);
}

}  // namespace constrictor::gaits
