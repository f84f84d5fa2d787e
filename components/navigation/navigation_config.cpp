#include "navigation/navigation_config.hpp"

#include "configuration/configuration.hpp"

namespace constrictor {
namespace {

constexpr Range kLength{0.0, 10.0};
constexpr Range kAngle{0.0, 6.3};
constexpr Range kTime{0.0, 600.0};
constexpr Range kTorque{0.0, 20.0};
constexpr Range kForce{0.0, 100.0};
constexpr Range kSpeed{0.001, 2.0};
constexpr Range kCurvature{0.0, 5.0};

Gait read_gait(Configuration& parent, const char* key) {
  Configuration section = parent.section(key);
  Gait gait;
  gait.frequency_hz = section.number("frequency_hz", {0.05, 2.0});
  gait.amplitude_rad = section.number("amplitude_rad", {0.0, 1.2});
  gait.wavelength_m = section.number("wavelength_m", {0.2, 5.0});
  section.finish();
  return gait;
}

PidGains read_pid(Configuration& parent, const char* key) {
  Configuration section = parent.section(key);
  PidGains gains;
  gains.kp = section.number("kp", {0.0, 100.0});
  gains.ki = section.number("ki", {0.0, 100.0});
  gains.kd = section.number("kd", {0.0, 100.0});
  gains.limit = section.number("limit_1_m", kCurvature);
  gains.derivative_filter_s = section.number("derivative_filter_s", kTime, 0.2);
  section.finish();
  return gains;
}

int read_int(Configuration& section, const char* key, int min, int max) {
  return static_cast<int>(section.integer(key, min, max));
}

void read_watches(Configuration& root, NavigationConfig& config) {
  Configuration line = root.section("line_watch");
  config.line.found_after = read_int(line, "found_after_images", 1, 100);
  config.line.lost_after = read_int(line, "lost_after_images", 1, 100);
  config.line.lookahead_m = line.number("lookahead_m", {0.1, 2.0});
  line.finish();
  Configuration object = root.section("object_watch");
  config.object.found_after = read_int(object, "found_after_images", 1, 100);
  config.object.lost_after = read_int(object, "lost_after_images", 1, 100);
  config.object.object_radius_m = object.number("object_radius_m", kLength);
  config.object.min_radius_m = object.number("min_radius_m", kLength);
  config.object.max_radius_m = object.number("max_radius_m", kLength);
  config.object.zone_radius_m = object.number("zone_radius_m", kLength);
  config.object.jump_m = object.number("jump_m", kLength);
  config.object.memory_images = object.number("memory_images", {1.0, 1000.0});
  object.finish();
}

void read_grip(Configuration& root, GripConfig& grip) {
  Configuration section = root.section("grip");
  grip.base_first_joint = read_int(section, "base_first_joint", 0, 60);
  grip.base_joints = read_int(section, "base_joints", 1, 8);
  grip.base_angle_rad = section.number("base_angle_rad", kAngle);
  grip.opening_share = section.number("opening_share", {0.0, 1.0});
  grip.hold_margin_rad = section.number("hold_margin_rad", kAngle);
  grip.hold_torque_nm = section.number("hold_torque_nm", kTorque);
  grip.lost_torque_nm = section.number("lost_torque_nm", kTorque);
  grip.lost_contact_share = section.number("lost_contact_share", {0.0, 1.0});
  grip.lost_filter_s = section.number("lost_filter_s", kTime);
  grip.lost_after_s = section.number("lost_after_s", kTime);
  grip.touch_force_n = section.number("touch_force_n", kForce);
  section.finish();
}

void read_line_and_search(Configuration& root, NavigationConfig& config) {
  Configuration follow = root.section("follow_line");
  config.follow_line.steering = read_pid(follow, "steering");
  config.follow_line.carry_limit_1_m = follow.number("carry_limit_1_m", kCurvature);
  config.follow_line.end_reached_m = follow.number("end_reached_m", kLength);
  config.follow_line.end_images = read_int(follow, "end_images", 1, 100);
  follow.finish();
  Configuration path = root.section("follow_path");
  config.follow_path.steering = read_pid(path, "steering");
  config.follow_path.lookahead_m = path.number("lookahead_m", kLength);
  config.follow_path.reached_m = path.number("reached_m", kLength);
  config.follow_path.lost_m = path.number("lost_m", kLength);
  path.finish();
  Configuration search = root.section("search_object");
  config.search.head_turn_rad = search.number("head_turn_rad", kAngle);
  config.search.head_rate_rad_s = search.number("head_rate_rad_s", kSpeed);
  config.search.near_m = search.number("near_m", kLength);
  config.search.remembered_m = search.number("remembered_m", kLength);
  config.search.advance_m = search.number("advance_m", kLength);
  config.search.turn_rad = search.number("turn_rad", kAngle);
  config.search.turn_curvature_1_m = search.number("turn_curvature_1_m", kCurvature);
  config.search.confirm_s = search.number("confirm_s", kTime);
  search.finish();
  Configuration track = root.section("track_object");
  config.track.steering = read_pid(track, "steering");
  config.track.reach_m = track.number("reach_m", kLength);
  config.track.reach_bearing_rad = track.number("reach_bearing_rad", kAngle);
  config.track.too_near_m = track.number("too_near_m", kLength);
  config.track.straight_rad = track.number("straight_rad", kAngle);
  config.track.away_m = track.number("away_m", kLength);
  config.track.turn_rad = track.number("turn_rad", kAngle);
  config.track.turn_curvature_1_m = track.number("turn_curvature_1_m", kCurvature);
  config.track.memory_s = track.number("memory_s", kTime);
  config.track.half_view_rad = track.number("half_view_rad", kAngle);
  track.finish();
}

void read_rotate_and_explore(Configuration& root, NavigationConfig& config) {
  Configuration rotate = root.section("rotate");
  config.rotate.curvature_1_m = rotate.number("curvature_1_m", kCurvature);
  config.rotate.carry_curvature_1_m = rotate.number("carry_curvature_1_m", kCurvature);
  rotate.finish();
  Configuration explore = root.section("explore");
  config.explore.head_turn_rad = explore.number("head_turn_rad", kAngle);
  config.explore.head_rate_rad_s = explore.number("head_rate_rad_s", kSpeed);
  config.explore.step_m = explore.number("step_m", kLength);
  config.explore.carry_turn_rad = explore.number("carry_turn_rad", kAngle);
  explore.finish();
}

void read_pregrasp(Configuration& root, PregraspConfig& pregrasp) {
  Configuration section = root.section("pregrasp");
  pregrasp.seen_within_s = section.number("seen_within_s", kTime);
  pregrasp.clearance_m = section.number("clearance_m", kLength);
  pregrasp.steering = read_pid(section, "steering");
  pregrasp.lookahead_m = section.number("lookahead_m", kLength);
  pregrasp.past_m = section.number("past_m", kLength);
  pregrasp.brake_m = section.number("brake_m", kLength);
  pregrasp.settle_s = section.number("settle_s", kTime);
  pregrasp.touch_rate_rad_s = section.number("touch_rate_rad_s", kSpeed);
  pregrasp.touch_limit_rad = section.number("touch_limit_rad", kAngle);
  pregrasp.touch_further_rad = section.number("touch_further_rad", kAngle);
  pregrasp.touch_force_n = section.number("touch_force_n", kForce);
  pregrasp.deep_min_m = section.number("deep_min_m", {-2.0, 1.0});
  pregrasp.deep_max_m = section.number("deep_max_m", {-1.0, 1.0});
  pregrasp.attempts = read_int(section, "attempts", 1, 20);
  pregrasp.other_clearance_m = section.number("other_clearance_m", kLength);
  section.finish();
}

void read_grasp(Configuration& root, GraspConfig& grasp) {
  Configuration section = root.section("grasp");
  grasp.wrap_speed_m_s = section.number("wrap_speed_m_s", kSpeed);
  grasp.wrap_still_m = section.number("wrap_still_m", kLength);
  grasp.wrap_speed_min_m_s = section.number("wrap_speed_min_m_s", kSpeed);
  grasp.wrap_speed_max_m_s = section.number("wrap_speed_max_m_s", kSpeed);
  grasp.wrap_speed_filter_s = section.number("wrap_speed_filter_s", {0.02, 60.0});
  grasp.wrap = read_gait(section, "wrap");
  grasp.seat = read_gait(section, "seat");
  grasp.squeeze = read_gait(section, "squeeze");
  grasp.touch_memory_s = section.number("touch_memory_s", kTime);
  grasp.seat_force_n = section.number("seat_force_n", kForce);
  grasp.seat_time_s = section.number("seat_time_s", kTime);
  grasp.seat_timeout_s = section.number("seat_timeout_s", kTime);
  grasp.squeeze_max_rad = section.number("squeeze_max_rad", kAngle);
  grasp.squeeze_torque_nm = section.number("squeeze_torque_nm", kTorque);
  grasp.squeeze_cap_nm = section.number("squeeze_cap_nm", kTorque);
  grasp.squeeze_attempts = read_int(section, "squeeze_attempts", 1, 20);
  grasp.touching_modules = read_int(section, "touching_modules", 0, 20);
  grasp.check_s = section.number("check_s", kTime);
  section.finish();
}

void read_drop(Configuration& root, DropConfig& drop) {
  Configuration section = root.section("drop");
  drop.steering = read_pid(section, "steering");
  drop.fix_course_m = section.number("fix_course_m", kLength);
  drop.brake_m = section.number("brake_m", kLength);
  drop.lookahead_m = section.number("lookahead_m", kLength);
  drop.open_angle_rad = section.number("open_angle_rad", kAngle);
  drop.open_s = section.number("open_s", {0.1, 60.0});
  drop.back_m = section.number("back_m", kLength);
  drop.back_timeout_s = section.number("back_timeout_s", kTime);
  drop.straighten_rate_rad_s = section.number("straighten_rate_rad_s", kSpeed);
  drop.approach_timeout_s = section.number("approach_timeout_s", kTime);
  section.finish();
}

}  // namespace

NavigationConfig load_navigation_config(const std::filesystem::path& file) {
  NavigationConfig config;
  Configuration root = Configuration::load(file);
  config.travel = read_gait(root, "travel");
  config.carry = read_gait(root, "carry");
  config.creep = read_gait(root, "creep");
  config.stale_after_ticks = root.integer("stale_after_ticks", 2, 10000);
  read_watches(root, config);
  read_grip(root, config.grip);
  read_line_and_search(root, config);
  read_rotate_and_explore(root, config);
  read_pregrasp(root, config.pregrasp);
  read_grasp(root, config.grasp);
  read_drop(root, config.drop);
  root.finish();
  return config;
}

}  // namespace constrictor
