// Common parts of the moving methods: ramps of the wave's parameters, and the setpoints of a wave on a posture.
#pragma once

#include <cstddef>
#include <optional>

#include "control/control_method.hpp"

namespace constrictor {

/// Ramps the body's wave towards that of the trajectory and advances its phase. `field`: as in Wave.
void advance_wave(const MethodInput& input, double field, BodyState& body);

/// Moves the posture towards `target_rad`, each joint at `rate_rad_s` or less. Returns the largest remaining angle
/// [rad].
double advance_shape(const MethodInput& input, const LinkArray& target_rad, double rate_rad_s, BodyState& body);

/// Begins the setpoints of all joints with the remainder of an earlier posture, which fades, and with the robot's own
/// torque limits.
void fade_residual(const MethodInput& input, BodyState& body, Setpoints& setpoints);

/// Fills in the setpoints: the wave on the posture, plus the remainder of an earlier posture; pitch joints at 0. Joints
/// in the base of the U that the posture `base_rad` defines get the torque limit of the trajectory, if it names one.
void ride(const MethodInput& input, const LinkArray& base_rad, BodyState& body, Setpoints& setpoints);

/// The posture of the trajectory, one angle for each yaw joint; 0 for joints that the trajectory does not name.
LinkArray desired_shape(const msg::DesiredTrajectory& desired, const YawChain& chain);

/// [rad/s] the rate of posture changes: that of the trajectory if it names one, otherwise the configured rate.
double desired_shape_rate(const MethodInput& input);

/// Whether a joint that is bent by `shape_rad` belongs to the base of a U.
inline bool is_base(const MethodInput& input, double shape_rad) {
  return shape_rad > input.config.base_bend_rad || shape_rad < -input.config.base_bend_rad;
}

/// The yaw joints of the base of a U.
struct UBase {
  std::size_t first, last;
};

/// Empty if the posture has no base.
std::optional<UBase> base_of(const MethodInput& input, const LinkArray& shape_rad);

/// Keeps the difference between the last command and the command of the present wave and posture as the remainder, so
/// that the setpoints do not jump when the method changes.
void keep_residual(const MethodInput& input, BodyState& body);

/// A method that takes the posture of the trajectory at a limited speed and rides the wave on it. The derived classes
/// differ in when the motion is done. One that varies the wave overrides step() and calls that of this class with
/// MethodInput::with_gait().
class PostureMethod : public ControlMethod {
 public:
  void start(const MethodInput& input, BodyState& body) const final { keep_residual(input, body); }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override;

 protected:
  /// `left_rad`: the largest angle between a joint and the desired posture.
  [[nodiscard]] virtual MethodProgress progress(double left_rad, BodyState& body) const = 0;
};

}  // namespace constrictor
