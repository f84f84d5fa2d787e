// How well the servos follow the gait of navigation, and whether they do the work that friction takes.
#include <cmath>

#include "bench/validation/checks.hpp"
#include "bench/validation/gait_run.hpp"

namespace constrictor::validation {

Section check_servos() {
  Section section{
      "Servos in the gait of navigation",
      "The setpoint moves on a smooth curve during a tick, so that the torque does not ring at the rate of the ticks. "
      "Ripple is the root mean square of the yaw joints' torques about their mean in each tick. Friction losses are "
      "those of all contacts.",
      {},
      {},
      {}};
  const RobotModel robot = mamba();
  const GaitMeasurement found = measure_gait(robot, open_loop_gait(robot, OpenLoopGait{}), {}, 3, 4);
  section.cases.push_back({"ripple of the torque within a tick", "Nm", 0.0, found.ripple_nm, 0.3, false});
  section.cases.push_back({"rms of setpoint minus angle", "rad", 0.0, found.tracking_rad, 0.005, false});
  section.cases.push_back({"work of the motors minus growth of the kinetic energy, against friction losses", "J",
                           found.friction_j, found.work_j - found.kinetic_change_j, 0.01});
  section.cases.push_back({"largest gap at a joint", "mm", 0.0, 1e3 * found.joint_gap_m, 0.2, false});
  return section;
}

}  // namespace constrictor::validation
