// Torques of the ground that the contacts of a step do not have: contacts are points, but a module has a flat belly,
// and an object that rolls deforms itself and the ground.
#pragma once

#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"
#include "sim/world/dynamics.hpp"

namespace constrictor {

/// Rolling resistance of an object that lies on the ground: its force as a share of its weight. An assumption, between
/// a hard wheel on a hard floor (0.01) and a soft one (0.1).
inline constexpr double kRollingResistance = 0.03;

/// Adds the torques with which the modules' bellies resist rolling in the next step.
void stand_on_bellies(const RobotModel& robot, const Scenario& scenario, Dynamics& dynamics);
/// Adds the torques that slow rolling objects down in the next step, which lasts `step_s`. The objects' bodies follow
/// those of `module_count` modules.
void resist_rolling(const Scenario& scenario, std::size_t module_count, double step_s, Dynamics& dynamics);

}  // namespace constrictor
