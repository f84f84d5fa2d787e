// Torques and deflections of joints that hold a part of the body over an edge.
#include <cmath>

#include "bench/validation/checks.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {
namespace {

constexpr std::size_t kOverhang = 6;
constexpr double kStiffness_nm_rad = 60.0;  // as in serpens.yaml

/// A robot of which the first six joints hold their modules in the air.
World cantilever(JointAxis axis, double stiffness_nm_rad) {
  RobotModel robot = chain(24, axis);
  for (JointModel& joint : robot.joints) {
    joint.stiffness_nm_rad = stiffness_nm_rad;
    joint.damping_nm_s_rad = stiffness_nm_rad > 0.0 ? 0.5 : 0.0;
  }
  World world(robot, beyond_an_edge(robot, axis, kOverhang));
  hold(world, 0.0, 6.0, 4.0);
  return world;
}

/// [Nm] that joint i holds: modules 0 to i, each in the middle of its length.
double held_nm(const RobotModel& robot, std::size_t joint) {
  const double modules = static_cast<double>(joint) + 1.0;
  return robot.module_mass_kg * kG * robot.module_length_m * 0.5 * modules * modules;
}

/// [Nm] the same with the levers that the modules have where the simulation has put them: a soft body hangs down.
double held_where_it_is_nm(const World& world, std::size_t joint) {
  const RobotModel& robot = world.robot();
  const double pivot_m = (world.module_pose(joint) * Eigen::Vector3d(-0.5 * robot.module_length_m, 0.0, 0.0)).x();
  double sum = 0.0;
  for (std::size_t i = 0; i <= joint; ++i)
    sum += robot.module_mass_kg * kG * (world.module_pose(i).translation().x() - pivot_m);
  return sum;
}

}  // namespace

Section check_joints() {
  Section section{
      "Joints",
      "A straight body reaches over an edge; joint i carries the modules in front of it, m g L (i + 1)²/2. "
      "Pitch joints hang over a table; for yaw joints gravity points sideways and the body lies on a wall. "
      "With a series spring (60 Nm/rad) the joint deflects by the torque over the stiffness; this soft body hangs "
      "down, so that the levers are those of the simulated posture.",
      {},
      {},
      {}};
  Plot torques{"Torque of each joint", "joint, counted from the head", "torque [Nm]", {}};
  Plot deflections{"Deflection of each series spring", "joint, counted from the head", "deflection [rad]", {}};
  const RobotModel robot = mamba();
  Series weight{"m g L (i + 1)^2 / 2", {}, {}, Mark::kLine};
  Series hooke{"moment of the weights / 60 Nm/rad", {}, {}, Mark::kLine};
  for (std::size_t i = 0; i < kOverhang; ++i) {
    weight.x.push_back(static_cast<double>(i));
    weight.y.push_back(held_nm(robot, i));
  }
  torques.series.push_back(weight);
  for (const auto& [axis, name] : {std::pair{JointAxis::kPitch, "pitch"}, std::pair{JointAxis::kYaw, "yaw"}}) {
    const World rigid = cantilever(axis, 0.0);
    const World elastic = cantilever(axis, kStiffness_nm_rad);
    Series torque{std::string(name) + " joints", weight.x, {}, Mark::kDots};
    hooke.x = weight.x;
    hooke.y.clear();
    Series deflection{std::string(name) + " joints", weight.x, {}, Mark::kDots};
    for (std::size_t i = 0; i < kOverhang; ++i) {
      torque.y.push_back(std::abs(rigid.joint_torque_nm(i)));
      deflection.y.push_back(std::abs(elastic.joint(i).motor_angle_rad() - elastic.joint_angle_rad(i)));
      section.cases.push_back(
          {fmt::format("{} joint {}: torque of the cantilever", name, i), "Nm", weight.y[i], torque.y.back(), 0.02});
    }
    for (std::size_t i = 0; i < kOverhang; ++i) {
      hooke.y.push_back(held_where_it_is_nm(elastic, i) / kStiffness_nm_rad);
      section.cases.push_back(
          {fmt::format("{} joint {}: deflection of the spring", name, i), "rad", hooke.y[i], deflection.y[i], 0.02});
    }
    torques.series.push_back(torque);
    if (axis == JointAxis::kPitch) deflections.series.push_back(hooke);
    deflections.series.push_back(deflection);
  }
  section.figures.push_back({"A body reaches over an edge", "cantilever.png", {torques, deflections}});
  return section;
}

}  // namespace constrictor::validation
