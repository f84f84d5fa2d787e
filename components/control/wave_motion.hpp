// What the moving methods share: ramps of the wave's parameters, and setpoints of a wave on a posture.
#pragma once

#include "control/control_method.hpp"

namespace constrictor {

/// Ramps the body's wave towards the trajectory's and advances its phase. `field` as in Wave.
void advance_wave(const MethodInput& input, double field, BodyState& body);

/// Moves the posture towards `target_rad`, each joint at most by `rate_rad_s`. Returns the largest angle that is left [rad].
double advance_shape(const MethodInput& input, const LinkArray& target_rad, double rate_rad_s, BodyState& body);

/// Setpoints of the body's wave on its posture plus what is left of an earlier one; pitch joints at 0. Joints that belong to the
/// base of a U (by `base_rad`, the posture that defines it) get the trajectory's torque limit if it names one.
void ride(const MethodInput& input, const LinkArray& base_rad, BodyState& body, Setpoints& setpoints);

/// The trajectory's posture by yaw joint; zeros where it names none.
LinkArray desired_shape(const msg::DesiredTrajectory& desired, const YawChain& chain);

/// The rate of posture changes that holds for this trajectory [rad/s].
double desired_shape_rate(const MethodInput& input);

/// True if a joint of this posture belongs to the base of a U.
inline bool is_base(const MethodInput& input, double shape_rad) {
  return shape_rad > input.config.base_bend_rad || shape_rad < -input.config.base_bend_rad;
}

/// Remembers the difference between what was commanded last and what the body's wave and posture would command now, so that
/// the change of method does not jump.
void keep_residual(const MethodInput& input, BodyState& body);

}  // namespace constrictor
