// A robot that carries an object in a bend of its body, without the components that do this in a run: the load under
// which the solver converges least.
#pragma once

#include <cstdint>

#include "bench/validation/gait_run.hpp"
#include "control/control_config.hpp"

namespace constrictor::validation {

struct CarryingMeasurement {
  double speed_m_s = 0.0;       ///< way of the robot's centre, second by second, divided by the time
  double torque_rms_nm = 0.0;   ///< filtered torques of the yaw joints
  double base_torque_nm = 0.0;  ///< mean of the joints that press on the object
  double object_force_n = 0.0;  ///< mean sum of the forces on the object
  double ground_force_n = 0.0;  ///< rms of the ground's force on a module
  double joint_gap_m = 0.0;     ///< largest
  std::int64_t unsolved = 0;    ///< steps whose equations were not solved to the engine's tolerance
  double slip_m = 0.0;          ///< how far the object has moved in the frame of the middle of the bend
};

/// Closes a bend of three yaw joints around a cylinder of 0.4 kg on the robot's left, squeezes it, and undulates for
/// ten seconds with the gait of the motion "carry" of `control`, whose pitch joints raise the bend by
/// `posture.lift_rad`. Takes 28 s of simulated time.
[[nodiscard]] CarryingMeasurement measure_carrying(const RobotModel& robot, const SolverSettings& settings,
                                                   const ControlConfig& control = {});

}  // namespace constrictor::validation
