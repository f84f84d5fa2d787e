#include "sim/world/joint_drive.hpp"

#include <algorithm>

namespace constrictor {

JointDrive::JointDrive(dWorldID world, const JointModel& model, dBodyID ahead, dBodyID behind, const dVector3 anchor,
                       const dVector3 axis)
    : model_(model), joint_(dJointCreateHinge(world, nullptr)), ahead_(ahead) {
  dJointAttach(joint_, ahead, behind);
  dJointSetHingeAnchor(joint_, anchor[0], anchor[1], anchor[2]);
  dJointSetHingeAxis(joint_, axis[0], axis[1], axis[2]);
  dJointSetHingeParam(joint_, dParamLoStop, model_.min_rad);
  dJointSetHingeParam(joint_, dParamHiStop, model_.max_rad);
  dJointSetFeedback(joint_, &feedback_);
}

double JointDrive::motor_angle_rad() const { return elastic() ? motor_angle_rad_ : angle_rad(); }

void JointDrive::drive(double step_s) {
  const double angle = angle_rad();
  const double limit_nm = setpoint_.torque_limit_nm;
  const double servo_angle = elastic() ? motor_angle_rad_ : angle;
  double velocity =
      std::clamp(model_.servo_gain_1_s * (setpoint_.position_rad - servo_angle) + setpoint_.velocity_rad_s,
                 -model_.max_speed_rad_s, model_.max_speed_rad_s);
  if (elastic()) {
    // The torque of the motor limits how far it can stretch the spring.
    const double k = model_.stiffness_nm_rad;
    const double d = model_.damping_nm_s_rad;
    const double stretch = limit_nm / k;
    const double moved = std::clamp(motor_angle_rad_ + step_s * velocity, angle - stretch, angle + stretch);
    velocity = limit_nm > 0.0 ? (moved - motor_angle_rad_) / step_s : 0.0;
    motor_angle_rad_ = moved;
    // The torque is k (motor - joint) + d (difference of their rates) at the end of the step. A velocity target with
    // this softness gives exactly that.
    const double softness = 1.0 / (step_s * k + d);
    velocity = (k * (motor_angle_rad_ - angle) + d * velocity) * softness;
    dJointSetHingeParam(joint_, dParamCFM, softness);
  }
  dJointSetHingeParam(joint_, dParamVel, velocity);
  dJointSetHingeParam(joint_, dParamFMax, limit_nm);
}

void JointDrive::measure(double step_s, double filter_s) {
  // The joint's wrench on the module ahead acts at the centre of that module; move it to the anchor and project it on
  // the axis.
  dVector3 anchor;
  dVector3 axis;
  dJointGetHingeAnchor(joint_, anchor);
  dJointGetHingeAxis(joint_, axis);
  const dReal* centre = dBodyGetPosition(ahead_);
  const dReal r[3] = {anchor[0] - centre[0], anchor[1] - centre[1], anchor[2] - centre[2]};
  const dReal* f = feedback_.f1;
  const dReal* t = feedback_.t1;
  step_torque_nm_ = axis[0] * (t[0] - (r[1] * f[2] - r[2] * f[1])) + axis[1] * (t[1] - (r[2] * f[0] - r[0] * f[2])) +
                    axis[2] * (t[2] - (r[0] * f[1] - r[1] * f[0]));
  torque_nm_ += (step_torque_nm_ - torque_nm_) * step_s / (filter_s + step_s);
}

}  // namespace constrictor
