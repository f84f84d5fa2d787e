#include "guidance/odometry.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "robot/kinematics.hpp"
#include "robot/planar.hpp"

namespace constrictor::guidance {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr int kIterations = 15;

/// Friction of one module in one of its two directions.
struct Slider {
  Eigen::Vector2d direction;
  double own_m_s;                ///< speed in that direction relative to the centre of mass
  double limit_n;                ///< Coulomb friction force at which the module slides
  double sideways_load_n = 0.0;  ///< load, if the direction is across the module
};

Eigen::Vector2d centre_of(const std::vector<PlanarPose>& poses) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const PlanarPose& pose : poses) sum += pose.p;
  return sum / static_cast<double>(poses.size());
}

/// Moves the estimate of a quantile towards a sample: up by `quantile` and down by 1 - `quantile`, times `step`. In the
/// long run, the share `quantile` of the samples lies below the estimate.
double follow_quantile(double estimate, double sample, double quantile, double step) {
  return estimate + (sample > estimate ? quantile : quantile - 1.0) * step;
}

/// Whether the force is known and great enough for a ratio of friction to load.
bool measurable(const GroundForce& force, const RobotModel& model) {
  return force.normal_n > 0.5 * model.module_mass_kg * kGravity_m_s2 && std::isfinite(force.along_n) &&
         std::isfinite(force.across_n);
}

void estimate_friction(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                       const OdometryInput& input) {
  constexpr double kDriving_m_s = 0.1;
  constexpr double kUpperQuartile = 0.75;
  if (std::hypot(state.vx_m_s, state.vy_m_s) < kDriving_m_s) return;
  // At first the estimates move fast, because the first guess may be far away.
  constexpr double kFast = 10.0;
  constexpr double kFast_s = 1.0;
  state.driven_s += input.dt_s;
  const double rate_1_s = config.friction_rate_1_s * (state.driven_s < kFast_s ? kFast : 1.0);
  const double step = rate_1_s * input.dt_s / static_cast<double>(model.module_count);
  for (const GroundForce& force : input.ground) {
    if (!measurable(force, model)) continue;
    // Friction along is several times smaller, and so are the steps of its estimate.
    const double along = std::abs(force.along_n) / force.normal_n, across = std::abs(force.across_n) / force.normal_n;
    state.friction_along = follow_quantile(state.friction_along, along, 0.5, 0.1 * step);
    state.friction_across = follow_quantile(state.friction_across, across, kUpperQuartile, step);
  }
  state.friction_across = std::clamp(state.friction_across, 0.01, 5.0);
  state.friction_along = std::clamp(state.friction_along, 0.0, state.friction_across);
}

/// [N] the normal force on a module.
double load_n(const OdometryInput& input, const RobotModel& model, std::size_t module) {
  const double weight_n = model.module_mass_kg * kGravity_m_s2;
  const bool measured = input.load_n.size() == model.module_count && std::isfinite(input.load_n[module]);
  return measured ? std::max(input.load_n[module], 0.0) : weight_n;
}

/// [N] the friction across a module at which it slides.
double across_n(const OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                const OdometryInput& input, std::size_t module) {
  const double limit_n = load_n(input, model, module) * state.friction_across;
  const bool sticks = module < input.ground.size() && measurable(input.ground[module], model) &&
                      std::abs(input.ground[module].across_n) <
                          config.stick_below * state.friction_across * input.ground[module].normal_n;
  return sticks ? limit_n * config.stick_factor : limit_n;
}

/// [rad] the turn of the head in a step whose turn was not measured: the balance of momentum as in advance_odometry(),
/// with the rate of the turn as a third unknown and the balance of angular momentum. `before_rad`: the joints before.
double estimated_turn_rad(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                          const OdometryInput& input, const std::vector<double>& before_rad) {
  const auto before = planar_module_poses(model, before_rad, {});
  const auto after = planar_module_poses(model, state.joint_rad, {});
  const Eigen::Vector2d centre_before = centre_of(before), centre_after = centre_of(after);
  const double half_m = 0.5 * model.module_length_m;
  const double mass_kg = model.module_mass_kg;
  struct Row {
    Eigen::Vector3d change;  // of the slip by the velocity (x, y) and the rate of the turn
    double own_m_s, limit_n;
  };
  std::vector<Row> rows;
  double spin = 0.0, inertia_kg_m2 = 0.0;  // about the centre of mass, while the head does not turn
  for (std::size_t i = 0; i < model.module_count; ++i) {
    const Eigen::Vector2d own = (after[i].p - before[i].p - (centre_after - centre_before)) / input.dt_s;
    const Eigen::Vector2d arm = 0.5 * (before[i].p - centre_before + after[i].p - centre_after);
    const double heading = 0.5 * (before[i].yaw_rad + after[i].yaw_rad);
    const double rate_rad_s = (after[i].yaw_rad - before[i].yaw_rad) / input.dt_s;
    const Eigen::Vector2d l = left(heading), a = along(heading), lever(-arm.y(), arm.x());
    const double rod_m2 = half_m * half_m / 3.0;
    spin += mass_kg * (lever.dot(own) + rod_m2 * rate_rad_s);
    inertia_kg_m2 += mass_kg * (arm.squaredNorm() + rod_m2);
    const double end_n = 0.5 * across_n(state, model, config, input, i);
    for (const double end_m : {half_m, -half_m})
      rows.push_back({{l.x(), l.y(), l.dot(lever) + end_m}, own.dot(l) + end_m * rate_rad_s, end_n});
    rows.push_back({{a.x(), a.y(), a.dot(lever)}, own.dot(a), load_n(input, model, i) * state.friction_along});
  }
  const double all_kg = mass_kg * static_cast<double>(model.module_count);
  const Eigen::Vector2d free = Eigen::Vector2d(state.vx_m_s, state.vy_m_s) + input.push_n * input.dt_s / all_kg +
                               kGravity_m_s2 * input.dt_s * input.downhill;
  const Eigen::Vector3d weight = Eigen::Vector3d(all_kg, all_kg, inertia_kg_m2) / input.dt_s;
  const Eigen::Vector3d aim(free.x(), free.y(), (state.spin_nms - spin) / inertia_kg_m2);
  Eigen::Vector3d motion = aim;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d A = weight.asDiagonal();
    Eigen::Vector3d b = weight.cwiseProduct(aim);
    for (const Row& row : rows) {
      const double slip = std::abs(row.change.dot(motion) + row.own_m_s);
      const double share = row.limit_n / std::max(slip, config.slip_scale_m_s);
      A += share * row.change * row.change.transpose();
      b -= share * row.own_m_s * row.change;
    }
    motion = A.inverse() * b;
  }
  if (!motion.allFinite()) motion = Eigen::Vector3d::Zero();
  state.spin_nms = spin + inertia_kg_m2 * motion.z();
  return motion.z() * input.dt_s;
}

}  // namespace

HeadStep advance_odometry(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                          const OdometryInput& input) {
  const std::size_t joints = model.joints.size();
  HeadStep result;
  if (!state.started || !(input.dt_s > 0.0)) {
    state.joint_rad.assign(input.joint_rad, input.joint_rad + joints);
    state.joint_rad_s.assign(input.joint_rad_s, input.joint_rad_s + joints);
    state.yaw_rad = std::isfinite(input.yaw_rad) ? input.yaw_rad : 0.0;
    state.vx_m_s = state.vy_m_s = 0.0;
    state.friction_along = config.friction_along;
    state.friction_across = config.friction_across;
    state.started = true;
    return result;
  }

  // The rates give the fast part of the angles and the measured angles give the slow part, so that neither noise nor
  // jitter counts as motion.
  const std::vector<double> before_rad = state.joint_rad;
  for (std::size_t i = 0; i < joints; ++i) {
    const double predicted = state.joint_rad[i] + 0.5 * input.dt_s * (state.joint_rad_s[i] + input.joint_rad_s[i]);
    state.joint_rad[i] = predicted + config.joint_gain * (input.joint_rad[i] - predicted);
    state.joint_rad_s[i] = input.joint_rad_s[i];
  }
  if (std::isfinite(input.yaw_rad)) {
    result.turn_rad = wrap_angle_by_shift(input.yaw_rad - state.yaw_rad);
    state.yaw_rad = input.yaw_rad;
    state.spin_nms = 0.0;
  } else {
    result.turn_rad = estimated_turn_rad(state, model, config, input, before_rad);
    state.yaw_rad = wrap_angle_by_shift(state.yaw_rad + result.turn_rad);
  }

  // The shapes of the body before and after the step. Their x axis is the heading of the head in the middle of the
  // step.
  const double half_turn = 0.5 * result.turn_rad;
  const auto before = planar_module_poses(model, before_rad, {{0.0, 0.0}, -half_turn});
  const auto after = planar_module_poses(model, state.joint_rad, {{0.0, 0.0}, half_turn});
  const Eigen::Vector2d centre_before = centre_of(before), centre_after = centre_of(after);

  estimate_friction(state, model, config, input);
  const std::size_t modules = model.module_count;
  const double mass_kg = model.module_mass_kg * static_cast<double>(modules);
  std::vector<Slider> sliders;
  sliders.reserve(3 * modules);
  double total_n = 0.0;
  for (std::size_t i = 0; i < modules; ++i) {
    const double module_n = load_n(input, model, i);
    total_n += module_n;
    const Eigen::Vector2d moved = (after[i].p - before[i].p) - (centre_after - centre_before);
    const double heading = 0.5 * (before[i].yaw_rad + after[i].yaw_rad);
    const Eigen::Vector2d own = moved / input.dt_s, l = left(heading), a = along(heading);
    const double end_n = 0.5 * across_n(state, model, config, input, i);
    // A module rests on its two ends.
    const double swing_m_s = 0.5 * model.module_length_m * (after[i].yaw_rad - before[i].yaw_rad) / input.dt_s;
    sliders.push_back({l, own.dot(l) + swing_m_s, end_n, 0.5 * module_n});
    sliders.push_back({l, own.dot(l) - swing_m_s, end_n, 0.5 * module_n});
    sliders.push_back({a, own.dot(a), module_n * state.friction_along});
  }

  // First compute the velocity without friction, then the velocity with friction.
  const double inertia = mass_kg / input.dt_s;
  const Eigen::Vector2d free = turned({state.vx_m_s, state.vy_m_s}, -half_turn) + input.push_n / inertia +
                               kGravity_m_s2 * input.dt_s * input.downhill;
  Eigen::Vector2d velocity = free;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix2d A = inertia * Eigen::Matrix2d::Identity();
    Eigen::Vector2d b = inertia * free;
    for (const Slider& s : sliders) {
      const double slip = std::abs(s.direction.dot(velocity) + s.own_m_s);
      const double weight = s.limit_n / std::max(slip, config.slip_scale_m_s);
      A += weight * s.direction * s.direction.transpose();
      b -= weight * s.own_m_s * s.direction;
    }
    const Eigen::Vector2d next = A.inverse() * b;
    const double change = (next - velocity).cwiseAbs().maxCoeff();
    velocity = next;
    if (change < 1e-6) break;
  }
  if (!velocity.allFinite()) velocity = Eigen::Vector2d::Zero();
  for (const Slider& s : sliders) {
    if (total_n > 0.0) result.slip_m_s += s.sideways_load_n / total_n * std::abs(s.direction.dot(velocity) + s.own_m_s);
  }
  // The shape gives the offset of the head from the centre of mass.
  result.drift_m = velocity * input.dt_s;
  result.step_m = result.drift_m - (centre_after - centre_before);
  const Eigen::Vector2d in_head = turned(velocity, -half_turn);
  state.vx_m_s = in_head.x();
  state.vy_m_s = in_head.y();
  return result;
}

}  // namespace constrictor::guidance
