#include "sim/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/ground_torques.hpp"
#include "sim/world/mechanism.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

/// The robot as it is in this scene; the components know only the robot file.
RobotModel real_robot(RobotModel robot, const Scenario& scenario) {
  robot.module_mass_kg *= scenario.body.mass_scale;
  return robot;
}

}  // namespace

World::World(const RobotModel& robot, const Scenario& scenario, const SolverSettings& settings)
    : robot_(real_robot(robot, scenario)),
      scenario_(scenario),
      settings_(settings),
      dynamics_(make_dynamics(mechanism_of(robot_, scenario_), settings)),
      contact_finder_(robot_, scenario_, settings),
      rows_(robot.joints.size()),
      pushes_n_(scenario.objects.size(), Vector3d::Zero()) {
  for (const JointModel& joint : robot_.joints) {
    drives_.emplace_back(joint);
    drives_.back().set({0.0, 0.0, joint.max_torque_nm});
  }
}

void World::set_servo(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
                      std::span<const double> torque_limit_nm) {
  if (position_rad.size() != drives_.size() || velocity_rad_s.size() != drives_.size() ||
      torque_limit_nm.size() != drives_.size()) {
    throw std::invalid_argument(
        fmt::format("World::set_servo: found {}, {} and {} entries, accepted {} (one for each joint)",
                    position_rad.size(), velocity_rad_s.size(), torque_limit_nm.size(), drives_.size()));
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i].set({position_rad[i], velocity_rad_s[i], torque_limit_nm[i]});
  }
}

void World::set_servo(std::span<const JointSetpoint> setpoints) {
  if (setpoints.size() != drives_.size())
    throw std::invalid_argument(fmt::format("World::set_servo: found {} setpoints, accepted {} (one for each joint)",
                                            setpoints.size(), drives_.size()));
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i].set(setpoints[i]);
}

void World::apply_force(std::size_t object, const Vector3d& force_n) { pushes_n_.at(object) += force_n; }

void World::move_object(std::size_t object, const Eigen::Vector2d& by_m) {
  if (object >= object_count())
    throw std::out_of_range(fmt::format("World::move_object: found object {}, accepted 0 to {}", object,
                                        static_cast<std::ptrdiff_t>(object_count()) - 1));
  dynamics_->move(object_body(object), {by_m.x(), by_m.y(), 0.0});
}

void World::advance(double duration_s, const std::function<void()>& after_step) {
  const auto count = std::max<std::int64_t>(1, std::llround(duration_s / settings_.step_s));
  const Vector3d velocity_before = module_velocity_m_s(0);
  contacts_.begin_tick();
  for (JointDrive& drive : drives_) drive.begin_tick(static_cast<int>(count), settings_.step_s);
  for (std::int64_t i = 0; i < count; ++i) {
    step();
    if (after_step) after_step();
  }
  acceleration_m_s2_ = (module_velocity_m_s(0) - velocity_before) / (static_cast<double>(count) * settings_.step_s);
  std::fill(pushes_n_.begin(), pushes_n_.end(), Vector3d::Zero());
  extend_hash();
}

void World::step() {
  for (std::size_t i = 0; i < drives_.size(); ++i) rows_[i] = drives_[i].drive();
  for (std::size_t i = 0; i < object_count(); ++i) dynamics_->add_force(object_body(i), pushes_n_[i]);
  stand_on_bellies(robot_, scenario_, *dynamics_);
  resist_rolling(scenario_, module_count(), settings_.step_s, *dynamics_);
  contacts_.begin_step();
  contact_finder_.find(*dynamics_, contacts_);
  dynamics_->step(rows_, contacts_.contacts());
  contacts_.collect(*dynamics_);
  for (std::size_t i = 0; i < drives_.size(); ++i)
    drives_[i].measure(dynamics_->angle_rad(i), dynamics_->rate_rad_s(i), dynamics_->torque_nm(i), settings_.step_s,
                       robot_.torque_filter_s);
  ++steps_done_;
}

Eigen::Isometry3d World::module_pose(std::size_t module) const { return dynamics_->body(module).pose(); }
Vector3d World::module_velocity_m_s(std::size_t module) const { return dynamics_->body(module).velocity_m_s; }
Vector3d World::module_angular_velocity_rad_s(std::size_t module) const {
  return dynamics_->body(module).angular_velocity_rad_s;
}
Eigen::Isometry3d World::object_pose(std::size_t object) const { return dynamics_->body(object_body(object)).pose(); }
Vector3d World::object_velocity_m_s(std::size_t object) const {
  return dynamics_->body(object_body(object)).velocity_m_s;
}
Vector3d World::object_angular_velocity_rad_s(std::size_t object) const {
  return dynamics_->body(object_body(object)).angular_velocity_rad_s;
}

ImuTruth World::imu() const {
  ImuTruth imu;
  imu.q_WHead = dynamics_->body(0).q_WB;
  const Eigen::Matrix3d R_HeadW = module_pose(0).linear().transpose();
  imu.angular_velocity_rad_s = R_HeadW * module_angular_velocity_rad_s(0);
  imu.proper_acceleration_m_s2 = R_HeadW * (acceleration_m_s2_ + (Vector3d::Zero() - scenario_.gravity_m_s2));
  if (scenario_.gravity_m_s2.norm() > 0.0) imu.up_W = -scenario_.gravity_m_s2.normalized();
  return imu;
}

void World::extend_hash() {
  hash_values_.clear();
  const auto append = [this](const auto& vector) {
    hash_values_.insert(hash_values_.end(), vector.data(), vector.data() + vector.size());
  };
  for (const BodyMotion& body : dynamics_->bodies()) {
    append(body.position_m);
    append(Eigen::Vector4d(body.q_WB.w(), body.q_WB.x(), body.q_WB.y(), body.q_WB.z()));
    append(body.velocity_m_s);
    append(body.angular_velocity_rad_s);
  }
  for (const JointDrive& drive : drives_) {
    hash_values_.push_back(drive.angle_rad());
    hash_values_.push_back(drive.rate_rad_s());
  }
  hash_.extend(hash_values_);
}

}  // namespace constrictor
