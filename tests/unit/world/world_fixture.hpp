// Robots, scenes and formulas for tests of the world.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "support/project.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {

inline constexpr double kPeriod_s = 0.02;
inline constexpr double kG = 9.81;  ///< [m/s²]

/// A test that runs with each engine of the dynamics.
class EachEngine : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static SolverSettings settings() {
    SolverSettings settings;
    settings.engine = GetParam();
    if (settings.engine == kEngineOde) {
      settings.step_s = 0.004;    // for which its softness and over-relaxation were chosen
      settings.iterations = 200;  // forces between bodies: within 2 %, with 100 iterations within 6 %
    }
    return settings;
  }
};

inline const auto kEngines = ::testing::Values(kEngineOde, kEngineChain);
inline std::string engine_name(const ::testing::TestParamInfo<std::string>& info) { return info.param; }

inline RobotModel mamba() { return load_robot(testing::robot_path("mamba")); }

/// A robot of `modules` modules whose joints all turn about the same axis.
inline RobotModel chain(std::size_t modules, JointAxis axis) {
  RobotModel robot = mamba();
  robot.module_count = modules;
  robot.joints.resize(modules - 1);
  for (JointModel& joint : robot.joints) joint.axis = axis;
  return robot;
}

/// The robot starts at this height and falls freely.
inline Scenario in_the_air(double height_m) {
  Scenario scenario;
  scenario.start_height_m = height_m;
  return scenario;
}

/// A cylinder (by default) on the ground, 2 m ahead of the robot.
inline Scenario with_object(const Eigen::Vector3d& size_m, double mass_kg) {
  Scenario scenario;
  ScenarioObject object;
  object.size_m = size_m;
  object.mass_kg = mass_kg;
  object.position_m = {2.0, 0.0};
  scenario.objects.push_back(object);
  return scenario;
}

/// All joints hold an angle for a time.
inline void hold(World& world, double angle_rad, double torque_nm, double seconds) {
  const std::size_t n = world.joint_count();
  world.set_servo(std::vector<double>(n, angle_rad), std::vector<double>(n, 0.0), std::vector<double>(n, torque_nm));
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kPeriod_s)); ++i) world.advance(kPeriod_s);
}

/// [kg m²] moment of inertia of a solid capsule about a transverse axis through its centre. `length` is that of its
/// cylinder.
inline double capsule_inertia(double mass, double radius, double length) {
  const double cylinder = std::numbers::pi * radius * radius * length;
  const double sphere = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  const double mc = mass * cylinder / (cylinder + sphere);
  const double ms = mass - mc;
  // The centre of mass of each half sphere is 3/8 r beyond the end of the cylinder.
  return mc * (radius * radius / 4 + length * length / 12) +
         ms * (2.0 / 5.0 * radius * radius + length * length / 4 + 3.0 / 8.0 * length * radius);
}

}  // namespace constrictor
