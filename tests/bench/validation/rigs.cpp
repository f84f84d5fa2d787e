#include "bench/validation/rigs.hpp"

#include <cmath>
#include <limits>
#include <numbers>

namespace constrictor::validation {

using Eigen::Vector3d;

Scenario beyond_an_edge(const RobotModel& robot, JointAxis axis, std::size_t overhang) {
  constexpr double kHeight_m = 0.5;
  constexpr double kBehind_m = 4.0;
  const double edge_m = -static_cast<double>(overhang) * robot.module_length_m;  // below the centre of a module
  Scenario scenario;
  ScenarioObstacle box;
  if (axis == JointAxis::kPitch) {
    box.size_m = {kBehind_m, 0.4, kHeight_m};
    box.position_m = {edge_m - 0.5 * kBehind_m, 0.0};
    scenario.start_height_m = kHeight_m;
  } else {
    constexpr double kThickness_m = 0.2;
    box.size_m = {kBehind_m, kThickness_m, 2.0 * kHeight_m};
    box.position_m = {edge_m - 0.5 * kBehind_m, -robot.module_radius_m - 0.5 * kThickness_m};
    scenario.start_height_m = kHeight_m;
    scenario.gravity_m_s2 = {0.0, -kG, 0.0};
  }
  scenario.obstacles.push_back(box);
  return scenario;
}

double Swing::period_s() const {
  std::vector<double> passages_s;
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double before = angle_rad[i - 1];
    const double now = angle_rad[i];
    if (before < 0.0 && now >= 0.0)
      passages_s.push_back(time_s[i - 1] + (time_s[i] - time_s[i - 1]) * before / (before - now));
  }
  if (passages_s.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  return (passages_s.back() - passages_s.front()) / static_cast<double>(passages_s.size() - 1);
}

Swing swing_head(double amplitude_rad, double duration_s, const SolverSettings& settings) {
  RobotModel robot = chain(16, JointAxis::kPitch);
  robot.joints[0].max_rad = 3.1;  // the head swings from the horizontal through the vertical and beyond it
  // The servos of a real robot yield to the swinging head and damp it. Here they are a hundred times as stiff.
  for (JointModel& joint : robot.joints) {
    joint.position_gain_nm_rad *= 100.0;
    joint.velocity_gain_nm_s_rad *= 10.0;
  }
  robot.joints[0].rotor_inertia_kg_m2 = kSwingingRotor_kg_m2;
  World world(robot, beyond_an_edge(robot, JointAxis::kPitch, 3), settings);
  const std::size_t n = world.joint_count();
  std::vector<double> angles(n, 0.0);
  std::vector<double> torques(n, 6.0);
  const std::vector<double> rates(n, 0.0);
  angles[0] = 0.5 * std::numbers::pi - amplitude_rad;
  for (int tick = 0; tick < 200; ++tick) {
    world.set_servo(angles, rates, torques);
    world.advance(kPeriod_s);
  }
  torques[0] = 0.0;  // relaxed
  world.set_servo(angles, rates, torques);
  const double mass = robot.module_mass_kg;
  const double inertia = capsule_inertia(mass, robot.module_radius_m, robot.module_length_m);
  Swing swing;
  const double begin_s = world.time_s();
  const auto record = [&] {
    const Eigen::Isometry3d X_WH = world.module_pose(0);
    const Vector3d forward = X_WH.linear().col(0);
    swing.time_s.push_back(world.time_s() - begin_s);
    swing.angle_rad.push_back(std::atan2(forward.x(), -forward.z()));
    swing.energy_j.push_back(0.5 * mass * world.module_velocity_m_s(0).squaredNorm() +
                             0.5 * inertia * world.module_angular_velocity_rad_s(0).squaredNorm() +
                             0.5 * kSwingingRotor_kg_m2 * std::pow(world.joint_rate_rad_s(0), 2) +
                             mass * kG * X_WH.translation().z());
  };
  while (world.time_s() - begin_s < duration_s) world.advance(kPeriod_s, record);
  return swing;
}

}  // namespace constrictor::validation
