#include "guidance/guidance_parameters.hpp"

namespace constrictor::guidance {

void add_parameters(GuidanceConfig& c, Parameters& p) {
  OdometryConfig& o = c.odometry;
  p.add(o.friction_along_share, "odometry.friction_along_share", "", {0.0, 2.0}, "of the robot file's friction along the modules");
  p.add(o.slip_scale_m_s, "odometry.slip_scale_m_s", "m/s", {1e-4, 1.0}, "sliding speed at which the skin's friction is developed");
  p.add(o.joint_gain, "odometry.joint_gain", "", {0.01, 1.0}, "share of a joint's measured angle against its integrated rate");
  p.add(c.speed_sd, "odometry.speed_sd", "", {0.0, 1.0}, "error of the estimated velocity, of the speed");
  p.add(c.yaw_sd_rad_sqrt_s, "odometry.yaw_sd_rad_sqrt_s", "rad/sqrt(s)", {0.0, 1.0}, "growth of the yaw's error");
  p.add(c.speed_window_s, "odometry.speed_window_s", "s", {0.1, 2.0}, "over which the published speed is averaged");
  p.add(c.bearing_sd_rad, "landmarks.bearing_sd_rad", "rad", {1e-3, 1.0}, "error of a percept's bearing");
  p.add(c.range_sd_m, "landmarks.range_sd_m", "m", {1e-3, 1.0}, "error of a percept's range at the head");
  p.add(c.max_range_m, "landmarks.max_range_m", "m", {0.1, 20.0}, "percepts farther off correct nothing");
  p.add(c.gate, "landmarks.gate", "", {1.0, 100.0}, "squared Mahalanobis distance up to which a percept belongs to a landmark");
  p.add(c.merge_m, "landmarks.merge_m", "m", {0.0, 5.0}, "off the gate but nearer than this: the landmark moved");
  p.add(c.confirm, "landmarks.confirm", "", {1.0, 100.0}, "percepts until a landmark is published");
  p.add(c.line_map_range_m, "line.map_range_m", "m", {0.1, 5.0}, "percepts of the line are mapped up to here");
  p.add(c.line_correct_after_s, "line.correct_after_s", "s", {0.0, 1000.0}, "points of the line known for longer correct the pose");
  p.add(c.touch_min_force_n, "touch.min_force_n", "N", {0.0, 100.0}, "weakest touch that is mapped");
  p.add(c.touch_keep_s, "touch.keep_s", "s", {0.1, 100.0}, "how long a touch stays in the map");
}

}  // namespace constrictor::guidance
