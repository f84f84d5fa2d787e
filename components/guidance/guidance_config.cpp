#include "guidance/guidance_config.hpp"

#include "configuration/configuration.hpp"

namespace constrictor::guidance {

GuidanceConfig load_guidance_config(const std::filesystem::path& file) {
  GuidanceConfig c;
  Configuration root = Configuration::load(file);
  Configuration odometry = root.section("odometry", false);
  OdometryConfig& o = c.odometry;
  o.friction_along_share = odometry.number("friction_along_share", {0.0, 2.0}, o.friction_along_share);
  o.slip_scale_m_s = odometry.number("slip_scale_m_s", {1e-4, 1.0}, o.slip_scale_m_s);
  o.joint_gain = odometry.number("joint_gain", {0.01, 1.0}, o.joint_gain);
  c.speed_sd = odometry.number("speed_sd", {0.0, 1.0}, c.speed_sd);
  c.speed_sd_m_s = odometry.number("speed_sd_m_s", {0.0, 1.0}, c.speed_sd_m_s);
  c.correlation_s = odometry.number("correlation_s", {0.01, 10.0}, c.correlation_s);
  c.yaw_sd_rad_sqrt_s = odometry.number("yaw_sd_rad_sqrt_s", {0.0, 1.0}, c.yaw_sd_rad_sqrt_s);
  c.speed_window_s = odometry.number("speed_window_s", {0.1, 2.0}, c.speed_window_s);
  odometry.finish();

  Configuration landmarks = root.section("landmarks", false);
  c.bearing_sd_rad = landmarks.number("bearing_sd_rad", {1e-3, 1.0}, c.bearing_sd_rad);
  c.range_sd_m = landmarks.number("range_sd_m", {1e-3, 1.0}, c.range_sd_m);
  c.range_sd_1_m = landmarks.number("range_sd_1_m", {0.0, 1.0}, c.range_sd_1_m);
  c.inflation = landmarks.number("inflation", {1.0, 1000.0}, c.inflation);
  c.max_range_m = landmarks.number("max_range_m", {0.1, 20.0}, c.max_range_m);
  c.gate = landmarks.number("gate", {1.0, 100.0}, c.gate);
  c.merge_m = landmarks.number("merge_m", {0.0, 5.0}, c.merge_m);
  c.confirm = static_cast<int>(landmarks.integer("confirm", 1, 100, c.confirm));
  landmarks.finish();

  Configuration line = root.section("line", false);
  c.line_spacing_m = line.number("spacing_m", {0.01, 1.0}, c.line_spacing_m);
  c.line_map_range_m = line.number("map_range_m", {0.1, 5.0}, c.line_map_range_m);
  c.line_correct_after_s = line.number("correct_after_s", {0.0, 1000.0}, c.line_correct_after_s);
  c.line_correct_sd_m = line.number("correct_sd_m", {1e-3, 1.0}, c.line_correct_sd_m);
  c.line_correct_gate_m = line.number("correct_gate_m", {0.01, 1.0}, c.line_correct_gate_m);
  line.finish();

  Configuration touch = root.section("touch", false);
  c.touch_min_force_n = touch.number("min_force_n", {0.0, 100.0}, c.touch_min_force_n);
  c.touch_max_normal_z = touch.number("max_normal_z", {0.0, 1.0}, c.touch_max_normal_z);
  c.touch_self_margin_m = touch.number("self_margin_m", {0.0, 0.1}, c.touch_self_margin_m);
  c.touch_keep_s = touch.number("keep_s", {0.1, 100.0}, c.touch_keep_s);
  touch.finish();
  root.finish();
  return c;
}

}  // namespace constrictor::guidance
