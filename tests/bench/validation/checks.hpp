// The groups of checks. Each one simulates, compares, and returns what it has found; none needs the others.
#pragma once

#include "bench/validation/results.hpp"

namespace constrictor::validation {

[[nodiscard]] Section check_free_bodies();     ///< free fall, pendulum, momentum, energy
[[nodiscard]] Section check_slopes();          ///< friction angle and acceleration on a slope
[[nodiscard]] Section check_joints();          ///< cantilever, series springs
[[nodiscard]] Section check_contact_forces();  ///< contact forces against weight
[[nodiscard]] Section check_gait_energy();     ///< work of the motors against friction
[[nodiscard]] Section check_planar_model();    ///< the gait against the planar model of Liljebäck's book
[[nodiscard]] Section check_servos();          ///< ripple, tracking and energy balance in the gait of navigation
[[nodiscard]] Section check_convergence();     ///< step and iterations of the solver: gait, empty and loaded
[[nodiscard]] Section check_speeds();          ///< speeds of the robot files beside published robots
[[nodiscard]] Section check_mujoco();          ///< the same robot in MuJoCo, if it is installed

}  // namespace constrictor::validation
