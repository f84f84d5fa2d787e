#include "bench/peg_fields/peg_trial.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/physics/sensors.hpp"

namespace constrictor::peg_fields {
namespace {

using Eigen::Vector2d;

constexpr double kOutline_s = 10.0;

Outline outline_of(const World& world) {
  Outline outline;
  for (std::size_t i = 0; i < world.module_count(); ++i)
    outline.push_back(world.module_pose(i).translation().head<2>());
  return outline;
}

Vector2d centre_of(const Outline& body) {
  return std::accumulate(body.begin(), body.end(), Vector2d(0.0, 0.0)) / static_cast<double>(body.size());
}

void note_pegs(const World& world, Course& course) {
  std::vector<bool> touches(world.module_count());
  for (const ModuleContact& contact : world.contacts()) {
    if (contact.touched != Touched::kObstacle) continue;
    touches[contact.module_index] = true;
    course.largest_peg_n = std::max(course.largest_peg_n, contact.force_n.norm());
  }
  course.touching_modules += static_cast<double>(std::count(touches.begin(), touches.end(), true));
}

}  // namespace

Scenario field_for(const RobotModel& robot, const FieldSpec& field, std::uint64_t seed) {
  const double length_m = robot.module_length_m * (static_cast<double>(robot.module_count) - 0.5);
  return draw_field(field, length_m, robot.module_radius_m, seed);
}

Course run(const RobotModel& robot_of_file, const FieldSpec& field, std::uint64_t seed, const Trial& trial) {
  RobotModel robot = robot_of_file;
  robot.friction_along = robot.friction_across = trial.ground_friction;
  World world(robot, field_for(robot, field, seed));
  Sensors sensors(robot, seed, true);
  MethodDriver driver(robot, trial.method);
  const double period_s = trial.method.period_s;
  const double weight_n = 9.81 * robot.module_mass_kg * static_cast<double>(robot.module_count);
  Course course;
  course.outlines.push_back(outline_of(world));
  const Vector2d from_m = centre_of(course.outlines.front());
  const auto ticks = static_cast<int>(std::lround(trial.longest_s / period_s));
  const auto outline_ticks = static_cast<int>(std::lround(kOutline_s / period_s));
  int tick = 0;
  while (tick < ticks && !course.goal_s) {
    const msg::JointState joints = sensors.joints(world);
    msg::ContactState felt{};
    msg::TouchedState touched{};  // the truth, which the method does not see
    sensors.contacts(world, felt, touched);
    const msg::ImuState imu = sensors.imu(world, period_s);
    JointArray angle_rad{}, rate_rad_s{}, torque_nm{};
    std::copy_n(joints.position_rad, world.joint_count(), angle_rad.begin());
    std::copy_n(joints.velocity_rad_s, world.joint_count(), rate_rad_s.begin());
    std::copy_n(joints.torque_nm, world.joint_count(), torque_nm.begin());
    Perceived around;
    around.contacts = &felt;
    around.imu = &imu;
    world.set_servo(driver.step(angle_rad, rate_rad_s, around, torque_nm));
    world.advance(period_s);
    ++tick;
    for (std::size_t j = 0; j < world.joint_count(); ++j)
      course.work_j += std::max(0.0, world.joint_torque_nm(j) * world.joint_rate_rad_s(j)) * period_s;
    note_pegs(world, course);
    course.duration_s = tick * period_s;
    const Outline body = outline_of(world);
    const Vector2d moved_m = centre_of(body) - from_m;
    course.way_m = moved_m.x();
    course.sideways_m = moved_m.y();
    if (course.way_m >= trial.goal_m) course.goal_s = course.duration_s;
    if (tick % outline_ticks == 0 || tick == ticks || course.goal_s) course.outlines.push_back(body);
  }
  course.touching_modules /= std::max(1, tick);
  course.transport = course.work_j / (weight_n * std::max(1e-3, std::hypot(course.way_m, course.sideways_m)));
  return course;
}

}  // namespace constrictor::peg_fields
