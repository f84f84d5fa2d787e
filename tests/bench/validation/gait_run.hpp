// Drives a simulated robot with a gait over whole cycles and measures it.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "bench/validation/lateral_undulation.hpp"
#include "bench/validation/rigs.hpp"

namespace constrictor::validation {

/// A periodic motion of all joints of a robot.
struct Gait {
  double period_s = 1.0;  ///< a multiple of the control period, so that the measurement covers whole cycles
  std::function<JointMotion(double time_s)> motion;
};

/// Yaw joints follow the gait of Liljebäck's book, pitch joints are straight.
[[nodiscard]] Gait lateral_gait(const RobotModel& robot, const LateralUndulation& gait);
/// The gait of this project's benchmarks and tests, with its period rounded to whole control periods.
[[nodiscard]] Gait open_loop_gait(const RobotModel& robot, OpenLoopGait gait);

/// One control period of the gait, from `time_s` on.
void drive(World& world, const Gait& gait, double time_s, const std::function<void()>& after_step = {});

/// [m] mean position of the modules.
[[nodiscard]] Eigen::Vector3d centre_of(const World& world);
/// [m] largest distance between the two ends that meet at a joint; 0 if the solver were exact.
[[nodiscard]] double largest_joint_gap_m(const World& world);
/// [N] sum in W of the forces on each module; with `touched`, only of those of what is touched.
[[nodiscard]] std::vector<Eigen::Vector3d> module_forces_n(const World& world, std::optional<Touched> touched = {});
/// [N^2] mean over the modules of the squared force of the ground on a module.
[[nodiscard]] double ground_force_square_n2(const World& world);

struct GaitMeasurement {
  double speed_m_s = 0.0;      ///< of the centre along the mean direction of the body, mean over whole cycles
  double torque_rms_nm = 0.0;  ///< of the yaw joints, from the mean torques of the ticks
  double ripple_nm = 0.0;      ///< rms of the yaw joints' torques in each step about the mean of the tick
  double tracking_rad = 0.0;   ///< rms of setpoint minus angle of the yaw joints, at the end of each tick
  double joint_gap_m = 0.0;    ///< largest
  double work_j = 0.0;         ///< of all joints on the body
  double friction_j = 0.0;     ///< taken by all contacts
  double kinetic_change_j = 0.0;
  double vertical_force_n = 0.0;  ///< mean sum of the contact forces
  double ground_force_n = 0.0;    ///< rms of the ground's force on a module
  double duration_s = 0.0;
};

[[nodiscard]] GaitMeasurement measure_gait(const RobotModel& robot, const Gait& gait,
                                           const SolverSettings& settings = {}, int settle_cycles = 2, int cycles = 3);

}  // namespace constrictor::validation
