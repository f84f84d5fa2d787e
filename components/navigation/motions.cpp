#include "navigation/motions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "constrictor/text.hpp"

namespace constrictor {
namespace {

/// Begins a new trajectory for this method.
void begin(const char* method, TaskOutput& output) {
  output.desired = {};
  output.desired.wavelength_m = 1.0;
  set_text(output.desired.method, method);
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
  const auto shape_rad = sense.open_shape(side, sense.open_angle_rad(grip.radius_m));
  output.desired.shape_count = static_cast<std::uint16_t>(sense.yaw_joint_count());
  std::copy_n(shape_rad.begin(), sense.yaw_joint_count(), output.desired.shape_rad);
}

void set_gait(const Gait& gait, double curvature_1_m, double direction, TaskOutput& output) {
  output.desired.frequency_hz = direction * gait.frequency_hz;
  output.desired.amplitude_rad = gait.amplitude_rad;
  output.desired.wavelength_m = gait.wavelength_m;
  output.desired.curvature_1_m = curvature_1_m;
}

}  // namespace

void stand(const Grip& grip, TaskOutput& output) {
  begin("hold", output);
  set_posture(grip, output);
}

void undulate(const Gait& gait, double curvature_1_m, double direction, const Grip& grip, TaskOutput& output) {
  begin("drive", output);
  set_gait(gait, curvature_1_m, direction, output);
  set_posture(grip, output);
}

void undulate_on(const Gait& gait, double curvature_1_m, double direction,
                 const std::array<double, msg::kMaxJoints>& shape_rad, std::size_t shape_count, TaskOutput& output) {
  begin("undulation", output);
  set_gait(gait, curvature_1_m, direction, output);
  output.desired.shape_count = static_cast<std::uint16_t>(shape_count);
  for (std::size_t k = 0; k < shape_count; ++k) output.desired.shape_rad[k] = shape_rad[k];
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

void wrap_round(const GripSense& sense, const Gait& gait, double side, double speed_m_s, const Grip& grip,
                TaskOutput& output) {
  undulate(gait, 0.0, 1.0, grip, output);
  set_text(output.desired.method, "wrap");
  set_open_u(sense, side, grip, output);
  output.desired.wrap_side = side;
  output.desired.speed_m_s = speed_m_s;
}

void squeeze_u(const NavigationConfig& config, const GripSense& sense, double side, const Grip& grip,
               TaskOutput& output) {
  undulate(gentle(config.grasp.squeeze, config, grip), 0.0, 1.0, grip, output);
  set_text(output.desired.method, "squeeze");
  set_open_u(sense, side, grip, output);
  output.desired.squeeze_rad = config.grasp.squeeze_max_rad;
  output.desired.torque_limit_nm = config.grasp.squeeze_cap_nm;
}

double tipping_acceleration_m_s2(const Grip& grip) {
  constexpr double kGravity_m_s2 = 9.81;
  if (grip.height_m <= 0.0) return std::numeric_limits<double>::infinity();
  return kGravity_m_s2 * grip.radius_m / (0.5 * grip.height_m);
}

double lateral_acceleration_m_s2(const Gait& gait) {
  return 2.0 * std::numbers::pi * gait.amplitude_rad * gait.wavelength_m * gait.frequency_hz * gait.frequency_hz;
}

Gait gentle(const Gait& gait, const NavigationConfig& config, const Grip& grip) {
  const double share = config.grip.tipping_share * tipping_acceleration_m_s2(grip) / lateral_acceleration_m_s2(gait);
  if (!(share < 1.0)) return gait;
  // A smaller wave carries farther than a slower one of the same acceleration, unless it is so small that it slips.
  constexpr double kLeastAmplitude_rad = 0.4;
  const double amplitude_rad = share * gait.amplitude_rad;
  Gait slower = gait;
  slower.amplitude_rad = std::max(amplitude_rad, std::min(gait.amplitude_rad, kLeastAmplitude_rad));
  slower.frequency_hz *= std::sqrt(amplitude_rad / slower.amplitude_rad);
  return slower;
}

Gait present_gait(const NavigationConfig& config, const Grip& grip) {
  return grip.carrying ? gentle(config.carry, config, grip) : config.travel;
}

double path_error_m(const PlanarPose& X_MH, const Eigen::Vector2d& p_M, double yaw_rad, double lookahead_m) {
  const PlanarPose X_MP{p_M, yaw_rad};
  const double along_m = X_MP.to_local(X_MH.p).x();
  return X_MH.to_local(X_MP.to_parent({along_m + lookahead_m, 0.0})).y();
}

double gait_period_s(const Gait& gait) { return 1.0 / std::max(0.1, std::abs(gait.frequency_hz)); }

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

double angle_between(double to_rad, double from_rad) {
  return std::remainder(to_rad - from_rad, 2.0 * std::numbers::pi);
}

}  // namespace constrictor
