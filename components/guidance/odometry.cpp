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
  double own_m_s;  ///< speed in that direction relative to the centre of mass
  double limit_n;  ///< Coulomb friction force at which the module slides
};

Eigen::Vector2d centre_of(const std::vector<PlanarPose>& poses) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const PlanarPose& pose : poses) sum += pose.p;
  return sum / static_cast<double>(poses.size());
}

}  // namespace

HeadStep advance_odometry(OdometryState& state, const RobotModel& model, const OdometryConfig& config,
                          const OdometryInput& input) {
  const std::size_t joints = model.joints.size();
  HeadStep result;
  if (!state.started || !(input.dt_s > 0.0)) {
    state.joint_rad.assign(input.joint_rad, input.joint_rad + joints);
    state.joint_rad_s.assign(input.joint_rad_s, input.joint_rad_s + joints);
    state.yaw_rad = input.yaw_rad;
    state.vx_m_s = state.vy_m_s = 0.0;
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
  result.turn_rad = wrap_angle_by_shift(input.yaw_rad - state.yaw_rad);
  state.yaw_rad = input.yaw_rad;

  // The shapes of the body before and after the step. Their x axis is the heading of the head in the middle of the
  // step.
  const double half_turn = 0.5 * result.turn_rad;
  const auto before = planar_module_poses(model, before_rad, {{0.0, 0.0}, -half_turn});
  const auto after = planar_module_poses(model, state.joint_rad, {{0.0, 0.0}, half_turn});
  const Eigen::Vector2d centre_before = centre_of(before), centre_after = centre_of(after);

  const std::size_t modules = model.module_count;
  const double mass_kg = model.module_mass_kg * static_cast<double>(modules);
  const bool measured = input.load_n.size() == modules;
  std::vector<Slider> sliders;
  sliders.reserve(2 * modules);
  double total_n = 0.0;
  for (std::size_t i = 0; i < modules; ++i) {
    double load_n = model.module_mass_kg * kGravity_m_s2;
    if (measured && std::isfinite(input.load_n[i])) load_n = std::max(input.load_n[i], 0.0);
    total_n += load_n;
    const Eigen::Vector2d moved = (after[i].p - before[i].p) - (centre_after - centre_before);
    const double heading = 0.5 * (before[i].yaw_rad + after[i].yaw_rad);
    const Eigen::Vector2d own = moved / input.dt_s, l = left(heading), a = along(heading);
    sliders.push_back({l, own.dot(l), load_n * model.friction_across});
    sliders.push_back({a, own.dot(a), load_n * model.friction_along * config.friction_along_share});
  }

  // First compute the velocity without friction, then the velocity with friction.
  const double inertia = mass_kg / input.dt_s;
  const Eigen::Vector2d free = turned({state.vx_m_s, state.vy_m_s}, -half_turn) + input.push_n / inertia;
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
  for (std::size_t i = 0; i < sliders.size(); i += 2) {
    const double share = total_n > 0.0 ? sliders[i].limit_n / (model.friction_across * total_n) : 0.0;
    if (std::isfinite(share))
      result.slip_m_s += share * std::abs(sliders[i].direction.dot(velocity) + sliders[i].own_m_s);
  }
  // The shape gives the offset of the head from the centre of mass.
  result.step_m = velocity * input.dt_s - (centre_after - centre_before);
  const Eigen::Vector2d in_head = turned(velocity, -half_turn);
  state.vx_m_s = in_head.x();
  state.vy_m_s = in_head.y();
  return result;
}

}  // namespace constrictor::guidance
