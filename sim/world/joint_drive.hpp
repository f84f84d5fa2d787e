// The servo of one joint and its hinge. In ODE's solver, the velocity motor of the hinge with its softness (CFM) acts
// as the servo.
#pragma once

#include <ode/ode.h>

#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"
#include "sim/world/servo.hpp"

namespace constrictor {

class JointDrive {
 public:
  /// Makes a hinge at `anchor` about `axis` (both in W) between the module at the head's side and the module behind it.
  /// Its angle is 0 in the present poses of the bodies.
  JointDrive(dWorldID world, const JointModel& model, dBodyID ahead, dBodyID behind, const dVector3 anchor,
             const dVector3 axis);

  void set(const JointSetpoint& setpoint) { servo_.set(setpoint); }
  void begin_tick(int steps, double step_s) { servo_.begin_tick(steps, step_s); }
  /// Call before each step: sets velocity, torque and softness of the motor.
  void drive();
  /// Call after each step: reads the torque of the hinge about its axis. `filter_s` is the time constant of the low
  /// pass.
  void measure(double step_s, double filter_s);

  [[nodiscard]] double angle_rad() const { return dJointGetHingeAngle(joint_); }
  [[nodiscard]] double rate_rad_s() const { return dJointGetHingeAngleRate(joint_); }
  [[nodiscard]] double torque_nm() const { return torque_nm_; }            ///< low-pass filtered
  [[nodiscard]] double step_torque_nm() const { return step_torque_nm_; }  ///< of the last step
  /// Differs from the joint's angle if the joint is elastic.
  [[nodiscard]] double motor_angle_rad() const { return servo_.elastic() ? servo_.motor_angle_rad() : angle_rad(); }
  [[nodiscard]] const Servo& servo() const { return servo_; }

  /// The memory of the drive between two ticks. The bodies, from which the angle follows, are not part of it.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(servo_, torque_nm_, step_torque_nm_);
  }

  // ODE keeps a pointer to feedback_.
  JointDrive(const JointDrive&) = delete;
  JointDrive& operator=(const JointDrive&) = delete;
  ~JointDrive() = default;

 private:
  Servo servo_;
  ServoRow row_;
  double angle_before_rad_ = 0.0;
  dJointID joint_;
  dBodyID ahead_;
  dJointFeedback feedback_{};
  double torque_nm_ = 0.0;
  double step_torque_nm_ = 0.0;
};

}  // namespace constrictor
