#include "navigation/motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "constrictor/text.hpp"
#include "navigation/carrying_room.hpp"
#include "navigation/mapped_line.hpp"
#include "robot/trajectory_path.hpp"

namespace constrictor {
namespace {

/// Begins a new trajectory for this kind of motion.
void begin(const char* motion, TaskOutput& output) {
  output.desired = {};
  set_text(output.desired.motion, motion);
}

void set_posture(const Grip& grip, TaskOutput& output) {
  if (!grip.carrying) return;
  output.desired.shape_count = 0;
  for (std::size_t k = 0; k < grip.shape_rad.size(); ++k) {
    output.desired.shape_rad[k] = grip.shape_rad[k];
    if (grip.shape_rad[k] != 0.0) output.desired.shape_count = static_cast<std::uint16_t>(k + 1);
  }
  output.desired.torque_limit_nm = grip.hold_torque_nm;
}

void set_open_u(const GripSense& sense, double side, const Grip& grip, TaskOutput& output) {
  const auto shape_rad = sense.open_shape(side, sense.open_angle_rad(grip));
  output.desired.shape_count = static_cast<std::uint16_t>(sense.yaw_joint_count());
  std::copy_n(shape_rad.begin(), sense.yaw_joint_count(), output.desired.shape_rad);
}

void set_pace(const Pace& pace, double curvature_1_m, double direction, TaskOutput& output) {
  output.desired.speed_m_s = direction * pace.speed_m_s;
  set_arc(curvature_1_m, output.desired);
}

}  // namespace

void stand(const Grip& grip, TaskOutput& output) {
  begin("stand", output);
  set_posture(grip, output);
}

void move_along(const Pace& pace, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output) {
  begin(pace.motion, output);
  set_pace(pace, curvature_1_m, direction, output);
  set_posture(grip, output);
}

void move_in_shape(const Pace& pace, double curvature_1_m, double direction,
                   const std::array<double, msg::kMaxJoints>& shape_rad, std::size_t shape_count, TaskOutput& output) {
  begin(pace.motion, output);
  set_pace(pace, curvature_1_m, direction, output);
  output.desired.shape_count = static_cast<std::uint16_t>(shape_count);
  for (std::size_t k = 0; k < shape_count; ++k) output.desired.shape_rad[k] = shape_rad[k];
}

void move_on_path(const TaskInput& input, const std::vector<Eigen::Vector2d>& points_M, const Grip& grip,
                  TaskOutput& output) {
  constexpr double kLongest_m = 50.0;  // well within the ranges of the message
  move_on(input, 0.0, 1.0, grip, output);
  output.desired.point_count = 0;
  double arc_m = 0.0;
  for (std::size_t i = 0; i + 1 < points_M.size() && i < msg::kMaxTrajectoryPoints && arc_m < kLongest_m; ++i) {
    const Eigen::Vector2d p_H = input.X_MH.to_local(points_M[i]);
    const Eigen::Vector2d d = input.X_MH.to_local(points_M[i + 1]) - p_H;
    output.desired.points[output.desired.point_count++] = {arc_m, p_H.x(), p_H.y(), std::atan2(d.y(), d.x()), 0.0};
    arc_m += d.norm();
  }
}

void bend_head(double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output) {
  bend_joints(0, each_rad, rate_rad_s, grip, output);
}

void bend_joints(std::size_t first, double each_rad, double rate_rad_s, const Grip& grip, TaskOutput& output) {
  constexpr std::size_t kBentJoints = 3;
  begin("bend", output);
  set_posture(grip, output);
  output.desired.shape_rate_rad_s = rate_rad_s;
  const std::size_t end = first + kBentJoints;
  output.desired.shape_count = std::max(output.desired.shape_count, static_cast<std::uint16_t>(end));
  for (std::size_t k = first; k < end; ++k) output.desired.shape_rad[k] += each_rad;
}

void wrap_round(const GripSense& sense, double speed_m_s, double side, double slide_m_s, const Grip& grip,
                TaskOutput& output) {
  move_along({"wrap", speed_m_s}, 0.0, 1.0, grip, output);
  set_open_u(sense, side, grip, output);
  output.desired.wrap_side = side;
  output.desired.slide_m_s = slide_m_s;
}

void squeeze_u(const NavigationConfig& config, const GripSense& sense, double side, const Grip& grip,
               TaskOutput& output) {
  move_along({"squeeze", config.grasp.squeeze_m_s}, 0.0, 1.0, grip, output);
  keep_upright(config, grip, output);
  set_open_u(sense, side, grip, output);
  output.desired.squeeze_rad = config.grasp.squeeze_max_rad;
  output.desired.torque_limit_nm = config.grasp.squeeze_cap_nm;
}

double tipping_acceleration_m_s2(const Grip& grip) {
  constexpr double kGravity_m_s2 = 9.81;
  if (grip.height_m <= 0.0) return std::numeric_limits<double>::infinity();
  return kGravity_m_s2 * grip.radius_m / (0.5 * grip.height_m);
}

void keep_upright(const NavigationConfig& config, const Grip& grip, TaskOutput& output) {
  constexpr double kAny_m_s2 = 100.0;  // no gait comes near it
  const double most_m_s2 = config.grip.tipping_share * tipping_acceleration_m_s2(grip);
  if (most_m_s2 < kAny_m_s2) output.desired.acceleration_m_s2 = most_m_s2;
}

Pace carrying_pace(const NavigationConfig& config) {
  return config.carries_on_ground ? Pace{"deliver", config.deliver_m_s} : Pace{"carry", config.carry_m_s};
}

Pace present_pace(const NavigationConfig& config, const Grip& grip) {
  return grip.carrying ? carrying_pace(config) : Pace{"travel", config.travel_m_s};
}

void move_on(const TaskInput& input, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output) {
  move_along(present_pace(input.config, grip), curvature_1_m, direction, grip, output);
  if (grip.carrying) keep_upright(input.config, grip, output);
}

void move_carefully(const TaskInput& input, double curvature_1_m, double direction, const Grip& grip,
                    TaskOutput& output) {
  if (!grip.carrying) return move_on(input, curvature_1_m, direction, grip, output);
  move_along({"deliver", input.config.deliver_m_s}, curvature_1_m, direction, grip, output);
  keep_upright(input.config, grip, output);
}

double path_error_m(const PlanarPose& X_MH, const Eigen::Vector2d& p_M, double yaw_rad, double lookahead_m) {
  const PlanarPose X_MP{p_M, yaw_rad};
  const double along_m = X_MP.to_local(X_MH.p).x();
  return X_MH.to_local(X_MP.to_parent({along_m + lookahead_m, 0.0})).y();
}

double carrying_shift_m(const TaskInput& input, const PlanarPose& X_HL) {
  if (!input.map) return 0.0;
  const FollowLineConfig& config = input.config.follow_line;
  return shift_from_line_m(*input.map, input.X_MH, X_HL, input.body, input.robot.module_radius_m + config.carry_room_m,
                           config.carry_ahead_m);
}

bool maps_wanted_line(const TaskInput& input) {
  return input.map != nullptr && input.map->line_colour == input.parameters.line_colour;
}

double mapped_offset_m(const TaskInput& input, double lookahead_m) {
  const BackToLineConfig& config = input.config.back_to_line;
  std::optional<PlanarPose> X_HL;
  if (input.map) X_HL = mapped_line_H(*input.map, input.X_MH, lookahead_m, config.aside_m, config.reach_m);
  return X_HL ? X_HL->p.y() + carrying_shift_m(input, *X_HL) : std::nan("");
}

double back_to_line_1_m(const TaskInput& input, SteeringState& state) {
  const BackToLineConfig& config = input.config.back_to_line;
  const double offset_m = mapped_offset_m(input, config.lookahead_m);
  Steering::observe(input.tick.time_s(), offset_m, input.sway_period_s, state);
  return Steering(config.steering).curvature(input.tick.dt_s(), state);
}

double body_course_rad(const TaskInput& input) {
  double turn_rad = 0.0;
  for (const PlanarPose& module : input.body) turn_rad += module.yaw_rad / static_cast<double>(input.body.size());
  return input.X_MH.yaw_rad + turn_rad;
}

double nearest_module_m(const TaskInput& input, const Eigen::Vector2d& p_M) {
  const Eigen::Vector2d p_H = input.X_MH.to_local(p_M);
  double nearest_m = p_H.norm();
  for (const PlanarPose& module : input.body) nearest_m = std::min(nearest_m, (module.p - p_H).norm());
  return nearest_m;
}

}  // namespace constrictor
