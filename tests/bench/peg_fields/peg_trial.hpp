// Drives the simulated robot through a field of pegs with one of control's methods.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "bench/method_driver.hpp"
#include "bench/peg_fields/peg_field.hpp"

namespace constrictor::peg_fields {

struct Trial {
  MethodTrial method;
  double ground_friction = 0.4;  ///< Coulomb coefficient of the skin on the ground, in each direction
  double goal_m = 3.0;           ///< way of the body's centre along x that ends the trial
  double longest_s = 120.0;      ///< the trial ends after this time in any case
};

/// The body from above: the centres of the modules from the head, in W.
using Outline = std::vector<Eigen::Vector2d>;

struct Course {
  std::optional<double> goal_s;  ///< time at which the body's centre had come goal_m forward
  double way_m = 0.0;            ///< of the body's centre along x, when the trial ended
  double duration_s = 0.0;
  double sideways_m = 0.0;        ///< of the body's centre along y, when the trial ended
  double transport = 0.0;         ///< cost of transport: positive work of the joints for weight times way
  double work_j = 0.0;            ///< positive work of the joints
  double touching_modules = 0.0;  ///< mean number of modules that touch a peg
  double largest_peg_n = 0.0;     ///< largest force of a peg on a module, mean over a tick
  std::vector<Outline> outlines;  ///< at the start, and after each ten seconds
  [[nodiscard]] double speed_m_s() const { return way_m / duration_s; }
};

/// The field of this seed for a robot that starts straight.
[[nodiscard]] Scenario field_for(const RobotModel& robot, const FieldSpec& field, std::uint64_t seed);

/// The sensors have the noise of the robot's file. Throws std::invalid_argument if control has no such method, or if
/// the method does not accept the trial.
[[nodiscard]] Course run(const RobotModel& robot, const FieldSpec& field, std::uint64_t seed, const Trial& trial);

}  // namespace constrictor::peg_fields
