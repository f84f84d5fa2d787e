#include "bench/sliding_mode/tracking_trial.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "constrictor/text.hpp"
#include "sim/world/world.hpp"

namespace constrictor::sliding_mode {
namespace {

constexpr unsigned kSeed = 20261123;

/// Control's method, limiter and safety rules, without the component around them.
class Driver {
 public:
  Driver(const RobotModel& robot, const Trial& trial)
      : robot_(robot), trial_(trial), chain_(robot), limiter_(robot, 1.0), method_(registry_.find(trial.method)) {
    if (!method_) throw std::invalid_argument("control has no method '" + trial.method + "'");
    set_text(desired_.method, trial.method);
    desired_.frequency_hz = trial.frequency_hz;
    desired_.amplitude_rad = 0.5;
    desired_.wavelength_m = 1.07;
  }

  /// The setpoints that act in the next tick. `reference` becomes the angles at its end.
  std::vector<JointSetpoint> step(const JointArray& angle, const JointArray& rate, JointArray& reference) {
    const std::size_t n = robot_.joints.size();
    if (!started_ || torque_mode_) limit_.position_rad = angle;
    const JointArray commanded = limit_.position_rad;
    const MethodInput input{robot_,          chain_, trial_.config, desired_, angle, JointArray{}, commanded,
                            trial_.period_s, {},     rate,          exerted_};
    if (!started_) method_->start(input, body_);
    started_ = true;
    Setpoints wanted;
    wanted.position_rad = commanded;
    for (std::size_t j = 0; j < n; ++j) wanted.torque_limit_nm[j] = robot_.joints[j].max_torque_nm;
    method_->step(input, body_, wanted);
    reference = wanted.position_rad;
    torque_mode_ = wanted.torque_mode;
    const msg::JointCommand command = limiter_.limit(wanted, angle, trial_.period_s, limit_);
    std::vector<JointSetpoint> setpoints(n);
    for (std::size_t j = 0; j < n; ++j) {
      setpoints[j] = {command.position_rad[j], command.velocity_rad_s[j], command.torque_limit_nm[j]};
      if (!torque_mode_) continue;
      const double torque_nm =
          safe_torque_nm(robot_.joints[j], command.torque_nm[j], angle[j], rate[j], trial_.period_s);
      setpoints[j] = {angle[j], 0.0, command.torque_limit_nm[j], torque_nm, true};
      exerted_[j] = torque_nm;
    }
    return setpoints;
  }

 private:
  const RobotModel& robot_;
  const Trial& trial_;
  YawChain chain_;
  JointLimiter limiter_;
  MethodRegistry registry_;
  const ControlMethod* method_;
  msg::DesiredTrajectory desired_{};
  BodyState body_;
  LimiterState limit_;
  JointArray exerted_{};
  bool started_ = false, torque_mode_ = false;
};

double heading_of(const World& world) {
  const Eigen::Vector3d axis =
      world.module_pose(0).translation() - world.module_pose(world.module_count() - 1).translation();
  return std::atan2(axis.y(), axis.x());
}

double rms(const std::vector<double>& values, bool about_mean) {
  double mean = 0.0, squares = 0.0;
  const auto count = static_cast<double>(values.size());
  for (const double value : values) mean += about_mean ? value / count : 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean) / count;
  return std::sqrt(squares);
}

}  // namespace

Tracking run(const RobotModel& robot, const Trial& trial) {
  RobotModel real = robot;
  real.friction_along *= trial.friction_share;
  real.friction_across *= trial.friction_share;
  real.module_mass_kg *= trial.mass_share;
  World world(real, Scenario{});
  Driver driver(robot, trial);
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0.0, robot.joint_position_noise_rad);
  const std::size_t n = robot.joints.size(), middle = n / 4 * 2;
  const auto yaw = robot.yaw_joints();
  std::vector<JointSetpoint> next;
  JointArray reference{}, before{};
  std::vector<double> errors, torques, headings;
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Tracking found;
  const auto ticks = static_cast<int>(std::lround(trial.duration_s / trial.period_s));
  const auto settle = static_cast<int>(std::lround(kSettle_s / trial.period_s));
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == settle) from_m = world.module_pose(n / 2).translation();
    JointArray angle{}, rate{};
    for (std::size_t j = 0; j < n; ++j) {
      angle[j] = world.joint_angle_rad(j) + noise(random);
      rate[j] = world.joint_rate_rad_s(j);
    }
    before = reference;
    const std::vector<JointSetpoint> later = driver.step(angle, rate, reference);
    if (!next.empty()) world.set_servo(next);
    next = later;
    world.advance(trial.period_s, [&] {
      if (tick < settle) return;
      for (std::size_t j = 0; j < n; ++j) {
        const double torque_nm = world.joint(j).step_torque_nm();
        torques.push_back(torque_nm);
        found.power_w += std::max(0.0, torque_nm * world.joint_rate_rad_s(j));
      }
    });
    if (tick < settle) continue;
    for (const std::size_t j : yaw) errors.push_back(world.joint_angle_rad(j) - before[j]);
    headings.push_back(heading_of(world));
    found.course.push_back({(tick + 1) * trial.period_s, before[middle], world.joint_angle_rad(middle)});
  }
  found.error_rad = rms(errors, false);
  found.heading_rad = rms(headings, true);
  found.torque_nm = rms(torques, false);
  found.power_w *= static_cast<double>(n) / static_cast<double>(torques.size());
  found.speed_m_s = (world.module_pose(n / 2).translation() - from_m).norm() / ((ticks - settle) * trial.period_s);
  return found;
}

}  // namespace constrictor::sliding_mode
