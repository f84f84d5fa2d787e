#include "sim/world/joint_drive.hpp"

#include <algorithm>

namespace constrictor {

JointDrive::JointDrive(dWorldID world, const JointModel& model, dBodyID ahead, dBodyID behind, const dVector3 anchor,
                       const dVector3 axis)
    : servo_(model), joint_(dJointCreateHinge(world, nullptr)), ahead_(ahead) {
  dJointAttach(joint_, ahead, behind);
  dJointSetHingeAnchor(joint_, anchor[0], anchor[1], anchor[2]);
  dJointSetHingeAxis(joint_, axis[0], axis[1], axis[2]);
  dJointSetHingeParam(joint_, dParamLoStop, model.min_rad);
  dJointSetHingeParam(joint_, dParamHiStop, model.max_rad);
  dJointSetFeedback(joint_, &feedback_);
}

void JointDrive::drive() {
  angle_before_rad_ = angle_rad();
  row_ = servo_.row(angle_before_rad_, rate_rad_s());
  dJointSetHingeParam(joint_, dParamVel, row_.velocity_rad_s);
  dJointSetHingeParam(joint_, dParamCFM, row_.softness);
  dJointSetHingeParam(joint_, dParamFMax, row_.torque_limit_nm);
}

void JointDrive::measure(double step_s, double filter_s) {
  servo_.advance(row_, angle_before_rad_, rate_rad_s());
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
