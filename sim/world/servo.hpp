// The servo of one joint: position controller, rotor, gear and, in some robots, a spring between gear and joint. It
// does not depend on ODE: it gives the solver one row for each step.
#pragma once

#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// What the solver knows of a servo in a step: the torque on the joint by the rate w of the joint at the end of the
/// step. It is the sum of a part with a limit, (velocity_rad_s - w) / softness but at most torque_limit_nm in either
/// direction, and of a part without one, inertia (free_velocity_rad_s - w). Under position control the rotor belongs to
/// the part with the limit, otherwise to the other one.
struct ServoRow {
  double velocity_rad_s = 0.0;
  double softness = 1.0;  ///< [rad/(s Nm)] > 0
  double torque_limit_nm = 0.0;
  double free_velocity_rad_s = 0.0;
  double inertia_nm_s_rad = 0.0;  ///< >= 0: moment of inertia by step

  [[nodiscard]] double torque_nm(double rate_rad_s) const;
  /// By which the torque falls with the rate.
  [[nodiscard]] double slope_nm_s_rad(double rate_rad_s) const;
  /// The rate at which there is no torque.
  [[nodiscard]] double torque_free_rate_rad_s() const;
};

/// Equations, with the setpoint r, the motor's angle m (at the output of the gear) and the joint's angle q:
///   motor:    J m" = u - f - t, u = kp (r - m) + kd (r' - m')
///   friction: |f| <= the friction of the gear in the robot file, so large that it only slows the motor down
///   spring:   t = k e + d e', where e = m - q, less half of the backlash towards 0, is the stretch of the series
///             elastic element; t = 0 while m - q is within the backlash; without an elastic element, m = q
///   encoder:  the controller reads m (q without an elastic element) with the encoder's resolution
///   limit:    |u - f - J m"| <= the smaller of the commanded limit and the speed-torque curve
/// While the servo is relaxed, u = 0, and rotor and friction have no limit. In torque mode, u is the commanded torque:
///   limits:   |u| <= the commanded limit and the speed-torque curve; u never accelerates the motor beyond the joint's
///             maximum speed; u is at most what the position controller would exert to stop the joint at its upper
///             limit, and at least what it would exert to stop it at its lower limit
/// Rates are those at the end of the step (implicit Euler, together with the bodies), so that every step is stable.
class Servo {
 public:
  explicit Servo(const JointModel& model) : model_(model) {}

  /// Sets where the setpoint is at the end of the next tick. The setpoint moves there during the tick on a cubic curve
  /// whose first derivative is continuous from tick to tick.
  void set(const JointSetpoint& setpoint);
  /// Call at the beginning of a tick of `steps` steps of `step_s`.
  void begin_tick(int steps, double step_s);
  /// The row for the next step of a joint with this angle and rate.
  [[nodiscard]] ServoRow row(double angle_rad, double rate_rad_s);
  /// Call after the step with the row that was used and the joint's rate at the end of the step.
  void advance(const ServoRow& row, double angle_before_rad, double rate_rad_s);

  [[nodiscard]] bool elastic() const { return model_.stiffness_nm_rad > 0.0; }
  [[nodiscard]] double motor_angle_rad() const { return motor_angle_rad_; }  ///< of an elastic joint
  [[nodiscard]] double setpoint_rad() const { return reference_rad_; }       ///< at the end of the last step

  /// The whole memory of the servo; the model of the joint is not part of it.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(from_, to_, step_, steps_, step_s_, reference_rad_, reference_rate_rad_s_, motor_angle_rad_,
            motor_rate_rad_s_, play_rad_, loose_, loose_motor_rad_s_);
  }

 private:
  [[nodiscard]] double torque_limit_nm(double rate_rad_s, double driving) const;
  /// The row of the position controller towards a reference: its angle at the beginning of the step, its rate at the
  /// end.
  [[nodiscard]] ServoRow position_row(double reference_rad, double reference_rate_rad_s, double angle_rad,
                                      double rate_rad_s);
  [[nodiscard]] ServoRow torque_row(double angle_rad, double rate_rad_s);
  /// The row of a motor without current: rotor and friction of the gear.
  [[nodiscard]] ServoRow relaxed_row(double angle_rad, double rate_rad_s);
  /// The Coulomb friction of the gear instead of a motor's torque.
  [[nodiscard]] ServoRow friction_row() const;
  /// The damping that exerts this friction at this rate, beside a motor: it never reverses the motion.
  [[nodiscard]] double friction_nm_s_rad(double rate_rad_s) const;
  /// The commanded torque within its limits, minus the friction of the gear, for a motor with this rate.
  [[nodiscard]] double motor_torque_nm(double motor_rate_rad_s) const;
  /// The row of the joint from that of the motor: with the spring between them, if there is one. While the gear does
  /// not touch, there is no torque.
  [[nodiscard]] ServoRow attached(const ServoRow& motor, double angle_rad, double rate_rad_s);
  /// Stretch of the elastic element at the beginning of the step, on the side of the backlash on which the gear will
  /// touch at its end; 0 while the gear does not touch there yet.
  [[nodiscard]] double stretch_rad(double angle_rad) const;
  /// Damping of the elastic element. As in position_row, its spring acts from where it is at the beginning of the step,
  /// which adds no damping; it is stable with at least h k of it, and then a spring without masses does not overshoot.
  [[nodiscard]] double spring_damping_nm_s_rad() const;

  JointModel model_;
  JointSetpoint from_;  ///< where the curve of this tick begins; a joint begins at rest at the angle 0
  JointSetpoint to_;    ///< where it ends
  int step_ = 0;
  int steps_ = 1;
  double step_s_ = 0.0;
  double reference_rad_ = 0.0;
  double reference_rate_rad_s_ = 0.0;
  double motor_angle_rad_ = 0.0;
  double motor_rate_rad_s_ = 0.0;
  double play_rad_ = 0.0;           ///< half of the backlash, with the sign of the side on which the gear touches
  bool loose_ = false;              ///< the gear will not touch in this step
  double loose_motor_rad_s_ = 0.0;  ///< rate of the motor then
};

}  // namespace constrictor
