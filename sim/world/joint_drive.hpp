// The servo of one joint and its hinge. ODE's velocity motor acts as a position servo, either stiff or through a series
// elastic element.
#pragma once

#include <ode/ode.h>

#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

class JointDrive {
 public:
  /// Makes a hinge at `anchor` about `axis` (both in W) between the module at the head's side and the module behind it.
  /// Its angle is 0 in the present poses of the bodies.
  JointDrive(dWorldID world, const JointModel& model, dBodyID ahead, dBodyID behind, const dVector3 anchor,
             const dVector3 axis);

  void set(const JointSetpoint& setpoint) { setpoint_ = clamp_to_limits(model_, setpoint); }
  /// Call before each step: sets velocity, torque and softness of the motor.
  void drive(double step_s);
  /// Call after each step: reads the torque of the hinge about its axis. `filter_s` is the time constant of the low
  /// pass.
  void measure(double step_s, double filter_s);

  [[nodiscard]] double angle_rad() const { return dJointGetHingeAngle(joint_); }
  [[nodiscard]] double rate_rad_s() const { return dJointGetHingeAngleRate(joint_); }
  [[nodiscard]] double torque_nm() const { return torque_nm_; }            ///< low-pass filtered
  [[nodiscard]] double step_torque_nm() const { return step_torque_nm_; }  ///< of the last step
  [[nodiscard]] double motor_angle_rad() const;  ///< differs from the joint's angle if the joint is elastic

  // ODE keeps a pointer to feedback_.
  JointDrive(const JointDrive&) = delete;
  JointDrive& operator=(const JointDrive&) = delete;
  ~JointDrive() = default;

 private:
  [[nodiscard]] bool elastic() const { return model_.stiffness_nm_rad > 0.0; }

  JointModel model_;
  dJointID joint_;
  dBodyID ahead_;
  dJointFeedback feedback_{};
  JointSetpoint setpoint_;
  double motor_angle_rad_ = 0.0;  ///< of the elastic element's motor side
  double torque_nm_ = 0.0;
  double step_torque_nm_ = 0.0;
};

}  // namespace constrictor
