// The parameters of navigation's section `grip`.
#pragma once

#include "navigation/navigation_section.hpp"

namespace constrictor {

/// The U that holds an object, and the monitor of its loss.
struct GripConfig : ParameterSet {
  int base_first_joint = add(base_first_joint, "base_first_joint", -1, "", {-1, 60}, kAtStart,
                             "First yaw joint of the base of the U, counted from the head; -1: arms of equal length");
  int base_joints =
      add(base_joints, "base_joints", 3, "", {1, 8}, kAtStart, "Number of yaw joints in the base of the U");
  double base_angle_rad = add(base_angle_rad, "base_angle_rad", 1.047, "rad", bounds::kAngle, kAtStart,
                              "Angle of each base joint in the open U");
  double widest_angle_rad =
      add(widest_angle_rad, "widest_angle_rad", 0.9, "rad", bounds::kAngle, kAtStart,
          "Smallest angle of each base joint in the open U: for a large object the U opens wider than base_angle_rad");
  double closing_rad = add(closing_rad, "closing_rad", 0.2, "rad", bounds::kAngle, kAtStart,
                           "Angle by which each base joint has to close until the base fits the object: the U opens "
                           "wider if it would be less");
  double tipping_share =
      add(tipping_share, "tipping_share", 0.87, "", {0.1, 100.0}, kAtStart,
          "Largest lateral acceleration of the arms, relative to the one that tips the object in the U over; the gaits "
          "become smaller for tall and narrow objects");
  double opening_share =
      add(opening_share, "opening_share", 0.5, "", bounds::kShare, kAtStart,
          "Share of the closing by which the joints beside the base open; equal to control's squeeze.opening_share");
  double hold_margin_rad = add(hold_margin_rad, "hold_margin_rad", 0.03, "rad", bounds::kAngle, kWhileRunning,
                               "Angle by which the held base joints are commanded to close further");
  double unfelt_margin_rad =
      add(unfelt_margin_rad, "unfelt_margin_rad", 0.2, "rad", bounds::kAngle, kWhileRunning,
          "The same without contact sensors: an object in the U keeps the base at its torque limit");
  double hold_torque_nm = add(hold_torque_nm, "hold_torque_nm", 1.5, "Nm", bounds::kTorque, kAtStart,
                              "Maximum torque of the base joints while the robot carries an object");
  double wide_hold_torque_nm =
      add(wide_hold_torque_nm, "wide_hold_torque_nm", 3.0, "Nm", bounds::kTorque, kAtStart,
          "The same for a large object, which keeps the base open: the arms have a longer lever");
  double opened_rad = add(opened_rad, "opened_rad", 0.45, "rad", bounds::kAngle, kWhileRunning,
                          "If the arms have opened the base by this sum of angles, a larger torque closes it");
  double closing_torque_nm = add(closing_torque_nm, "closing_torque_nm", 4.0, "Nm", bounds::kTorque, kWhileRunning,
                                 "Torque that closes a base that the arms have opened");
  double lost_torque_nm = add(lost_torque_nm, "lost_torque_nm", 0.75, "Nm", bounds::kTorque, kWhileRunning,
                              "Mean closing torque of the base below which a held object may be lost");
  double lost_contact_share = add(lost_contact_share, "lost_contact_share", 0.25, "", bounds::kShare, kWhileRunning,
                                  "Share of time with a touch of the base below which a held object may be lost");
  double untouched_share =
      add(untouched_share, "untouched_share", 0.05, "", bounds::kShare, kWhileRunning,
          "Share of time with a touch of the base below which the object is lost whatever the torque");
  double lost_filter_s = add(lost_filter_s, "lost_filter_s", 1.0, "s", bounds::kTime, kAtStart,
                             "Time constant of the low-pass on the torque and on the share of time with a touch");
  double lost_after_s = add(lost_after_s, "lost_after_s", 2.0, "s", bounds::kTime, kWhileRunning,
                            "An object is lost after torque and touch have been too low for this time");
  double touch_force_n = add(touch_force_n, "touch_force_n", 0.4, "N", bounds::kForce, kWhileRunning,
                             "Weakest force that counts as a touch");
};

}  // namespace constrictor
