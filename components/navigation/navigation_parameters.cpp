#include "navigation/navigation_parameters.hpp"

#include <string>

namespace constrictor {
namespace {

constexpr ParameterBounds kLength{0.0, 10.0};
constexpr ParameterBounds kAngle{0.0, 6.3};
constexpr ParameterBounds kTime{0.0, 600.0};
constexpr ParameterBounds kTorque{0.0, 20.0};
constexpr ParameterBounds kForce{0.0, 100.0};
constexpr ParameterBounds kSpeed{0.001, 2.0};
constexpr ParameterBounds kCurvature{0.0, 5.0};
constexpr ParameterBounds kImages{1.0, 100.0};

void add_gait(Parameters& p, Gait& gait, const std::string& key, const std::string& what) {
  p.add(gait.frequency_hz, key + ".frequency_hz", "Hz", {0.05, 2.0}, what + ": undulations per second");
  p.add(gait.amplitude_rad, key + ".amplitude_rad", "rad", {0.0, 1.2}, what + ": amplitude of the wave's heading");
  p.add(gait.wavelength_m, key + ".wavelength_m", "m", {0.2, 5.0}, what + ": length of the wave along the body");
}

void add_pid(Parameters& p, PidGains& gains, const std::string& key, const std::string& error) {
  p.add(gains.kp, key + ".kp", "", {0.0, 100.0}, "curvature for the " + error + ": proportional gain");
  p.add(gains.ki, key + ".ki", "1/s", {0.0, 100.0}, "curvature for the " + error + ": integral gain");
  p.add(gains.kd, key + ".kd", "s", {0.0, 100.0}, "curvature for the " + error + ": derivative gain");
  p.add(gains.limit, key + ".limit_1_m", "1/m", kCurvature, "curvature for the " + error + ": bound");
}

void add_senses(NavigationConfig& c, Parameters& p) {
  p.add(c.line.found_after, "line_watch.found_after_images", "", kImages, "images in a row that show the line until it is found");
  p.add(c.line.lost_after, "line_watch.lost_after_images", "", kImages, "images in a row without the line until it is lost");
  p.add(c.line.lookahead_m, "line_watch.lookahead_m", "m", {0.1, 2.0}, "where ahead of the head the line's offset is taken");
  p.add(c.object.found_after, "object_watch.found_after_images", "", kImages, "images in a row that show an object until it is found");
  p.add(c.object.lost_after, "object_watch.lost_after_images", "", kImages, "images in a row without the object until it is lost");
  p.add(c.object.jump_m, "object_watch.jump_m", "m", kLength, "an object seen farther off than this has been moved");
}

void add_grip(GripConfig& grip, Parameters& p) {
  p.add(grip.hold_margin_rad, "grip.hold_margin_rad", "rad", kAngle, "by how much more than it has the base is asked to close");
  p.add(grip.lost_torque_nm, "grip.lost_torque_nm", "Nm", kTorque, "closing torque below which a grasp may be lost");
  p.add(grip.lost_contact_share, "grip.lost_contact_share", "", {0.0, 1.0}, "share of time with a touch below which it may be lost");
  p.add(grip.lost_after_s, "grip.lost_after_s", "s", kTime, "how long both must stay below until it is lost");
  p.add(grip.touch_force_n, "grip.touch_force_n", "N", kForce, "weakest touch that counts");
}

void add_tasks(NavigationConfig& c, Parameters& p) {
  p.add(c.follow_line.carry_limit_1_m, "follow_line.carry_limit_1_m", "1/m", kCurvature, "bound of the curvature while carrying");
  p.add(c.follow_line.end_reached_m, "follow_line.end_reached_m", "m", kLength, "distance to the line's end at which it is reached");
  p.add(c.follow_path.lookahead_m, "follow_path.lookahead_m", "m", kLength, "point of the path steered for, ahead of the head");
  p.add(c.follow_path.reached_m, "follow_path.reached_m", "m", kLength, "the path ends so far before its last point");
  p.add(c.search.head_rate_rad_s, "search_object.head_rate_rad_s", "rad/s", kSpeed, "of each joint that turns the looking head");
  p.add(c.track.reach_m, "track_object.reach_m", "m", kLength, "distance from head to surface at which an object is reached");
  p.add(c.rotate.curvature_1_m, "rotate.curvature_1_m", "1/m", kCurvature, "curvature of turning on the spot");
  p.add(c.pregrasp.clearance_m, "pregrasp.clearance_m", "m", kLength, "between body and object while passing it");
  p.add(c.pregrasp.touch_force_n, "pregrasp.touch_force_n", "N", kForce, "touch that ends the feeling for an object");
  p.add(c.grasp.seat_force_n, "grasp.seat_force_n", "N", kForce, "touch in the base's middle that seats an object");
  p.add(c.grasp.squeeze_torque_nm, "grasp.squeeze_torque_nm", "Nm", kTorque, "closing torque at which an object is firm");
  p.add(c.grasp.squeeze_cap_nm, "grasp.squeeze_cap_nm", "Nm", kTorque, "bound of the base's torque while squeezing");
  p.add(c.drop.fix_course_m, "drop.fix_course_m", "m", kLength, "distance from the zone's centre at which the course is fixed");
}

}  // namespace

void add_parameters(NavigationConfig& c, Parameters& p) {
  add_gait(p, c.travel, "travel", "gait without an object");
  add_gait(p, c.carry, "carry", "gait in the U with an object");
  add_gait(p, c.creep, "creep", "small steps beside an object");
  add_pid(p, c.follow_line.steering, "follow_line.steering", "line's offset [m]");
  add_pid(p, c.follow_path.steering, "follow_path.steering", "path's offset [m]");
  add_pid(p, c.track.steering, "track_object.steering", "object's bearing [rad]");
  add_pid(p, c.drop.steering, "drop.steering", "distance to the course [m]");
  add_senses(c, p);
  add_grip(c.grip, p);
  add_tasks(c, p);
}

}  // namespace constrictor
