// The servo of one joint and its hinge: ODE's velocity motor, driven as a position servo in each step, stiff or through a series
// elastic element.
#pragma once

#include <ode/ode.h>

#include "robot/joint_limits.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

class JointDrive {
 public:
  /// A hinge between the module at the head's side and the one behind it, at `anchor` about `axis` (in the world), its angle 0 in
  /// the bodies' present poses.
  JointDrive(dWorldID world, const JointModel& model, dBodyID ahead, dBodyID behind, const dVector3 anchor,
             const dVector3 axis);

  void set(const JointSetpoint& setpoint) { setpoint_ = clamp_to_limits(model_, setpoint); }
  /// Before a step: sets the motor's velocity, torque and softness.
  void drive(double step_s);
  /// After a step: reads the torque that the hinge exerts about its axis.
  void measure(double step_s, double filter_s);

  [[nodiscard]] double angle_rad() const { return dJointGetHingeAngle(joint_); }
  [[nodiscard]] double rate_rad_s() const { return dJointGetHingeAngleRate(joint_); }
  [[nodiscard]] double torque_nm() const { return torque_nm_; }          ///< low-passed
  [[nodiscard]] double step_torque_nm() const { return step_torque_nm_; }  ///< of the last step
  [[nodiscard]] double motor_angle_rad() const;                          ///< differs from the joint's if elastic

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
