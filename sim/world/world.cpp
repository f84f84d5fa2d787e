#include "sim/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/kinematics.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

Eigen::Isometry3d upright(const Eigen::Vector2d& position_m, double height_m, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Vector3d(position_m.x(), position_m.y(), height_m);
  return pose;
}

OdeGeom make_geom(BodyShape shape, const Vector3d& size_m) {
  ensure_ode();
  return OdeGeom(shape == BodyShape::kCylinder ? dCreateCylinder(nullptr, size_m.x(), size_m.z())
                                               : dCreateBox(nullptr, size_m.x(), size_m.y(), size_m.z()));
}

double bound_of(BodyShape shape, const Vector3d& size_m) {
  return shape == BodyShape::kCylinder ? std::hypot(size_m.x(), 0.5 * size_m.z()) : 0.5 * size_m.norm();
}

RigidBody body_of(const dMass& mass, const Eigen::Isometry3d& X_WB) {
  return {mass.mass, {mass.I[0], mass.I[5], mass.I[10]}, X_WB};
}

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
      dynamics_(make_dynamics(mechanism(), settings)),
      rows_(robot.joints.size()),
      capsules_(robot.module_count) {
  for (const JointModel& joint : robot_.joints) {
    drives_.emplace_back(joint);
    drives_.back().set({0.0, 0.0, joint.max_torque_nm});
  }
  build_objects();
  build_obstacles();
}

Mechanism World::mechanism() const {
  Mechanism mechanism;
  mechanism.joints = robot_.joints;
  mechanism.half_length_m = 0.5 * robot_.module_length_m;
  mechanism.radius_m = robot_.module_radius_m;
  mechanism.gravity_m_s2 = scenario_.gravity_m_s2;
  dMass mass;
  dMassSetCapsuleTotal(&mass, robot_.module_mass_kg, 1, robot_.module_radius_m, robot_.module_length_m);
  const Eigen::Isometry3d X_WHead =
      upright(scenario_.start_m, scenario_.start_height_m + robot_.module_radius_m, scenario_.start_yaw_rad);
  for (const Eigen::Isometry3d& pose : module_poses(robot_, {}, X_WHead))
    mechanism.modules.push_back(body_of(mass, pose));
  for (const ScenarioObject& object : scenario_.objects) {
    const Vector3d& size = object.size_m;
    if (object.shape == BodyShape::kCylinder) {
      dMassSetCylinderTotal(&mass, object.mass_kg, 3, size.x(), size.z());
    } else {
      dMassSetBoxTotal(&mass, object.mass_kg, size.x(), size.y(), size.z());
    }
    mechanism.objects.push_back(body_of(mass, upright(object.position_m, 0.5 * size.z(), object.yaw_rad)));
  }
  return mechanism;
}

void World::build_objects() {
  for (const ScenarioObject& object : scenario_.objects) {
    object_geoms_.push_back(make_geom(object.shape, object.size_m));
    object_bound_m_.push_back(bound_of(object.shape, object.size_m));
  }
  pushes_n_.assign(object_count(), Vector3d::Zero());
}

void World::build_obstacles() {
  for (const ScenarioObstacle& obstacle : scenario_.obstacles) {
    Obstacle built;
    built.solid = {obstacle.shape, obstacle.size_m,
                   upright(obstacle.position_m, 0.5 * obstacle.size_m.z(), obstacle.yaw_rad)};
    built.geom = make_geom(obstacle.shape, obstacle.size_m);
    built.bound_m = bound_of(obstacle.shape, obstacle.size_m);
    const Vector3d& p = built.solid.X_WS.translation();
    dMatrix3 R;
    dRFromAxisAndAngle(R, 0.0, 0.0, 1.0, obstacle.yaw_rad);
    dGeomSetPosition(built.geom.get(), p.x(), p.y(), p.z());
    dGeomSetRotation(built.geom.get(), R);
    obstacles_.push_back(std::move(built));
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

// A flat underside of half-width w resists rolling with a torque of at most weight times w. The torque grows linearly
// over a small angle, because a step would excite the solver. A module that is tipped further than kTipped_rad rests on
// its round side and feels no such torque.
void World::stand_on_bellies() {
  constexpr double kSoft_rad = 0.05;
  constexpr double kTipped_rad = 0.8;
  constexpr double kDamping_s = 0.01;
  constexpr double kNear_m = 0.01;
  const double most_nm = robot_.module_mass_kg * -scenario_.gravity_m_s2.z() * robot_.module_belly_half_width_m;
  if (most_nm <= 0.0) return;
  for (std::size_t i = 0; i < module_count(); ++i) {
    const BodyMotion& body = dynamics_->body(i);
    const Vector3d axis = body.R_WB.col(0);
    const double roll_rad = std::atan2(body.R_WB(2, 1), body.R_WB(2, 2));
    if (std::abs(roll_rad) > kTipped_rad || body.position_m.z() > robot_.module_radius_m + kNear_m) continue;
    const double rate_rad_s = body.angular_velocity_rad_s.dot(axis);
    const double share = std::clamp((roll_rad + kDamping_s * rate_rad_s) / kSoft_rad, -1.0, 1.0);
    dynamics_->add_torque(i, axis * (-most_nm * share));
  }
}

// Without this torque, a cylinder that was knocked over would roll on for ever. The torque of an object that rolls
// slowly is proportional to its rate. One step removes at most half of the rate, so that the object cannot oscillate.
void World::resist_rolling() {
  constexpr double kSoft_rad_s = 0.05;
  constexpr double kMostOfRate = 0.5;
  for (std::size_t i = 0; i < object_count(); ++i) {
    const ScenarioObject& object = scenario_.objects[i];
    const Vector3d& rate = dynamics_->body(object_body(i)).angular_velocity_rad_s;
    const double rolling_rad_s = std::hypot(rate.x(), rate.y());
    if (rolling_rad_s < 1e-9) continue;
    const double lever_m = object.shape == BodyShape::kCylinder ? object.size_m.x() : 0.5 * object.size_m.minCoeff();
    const double weight_n = object.mass_kg * -scenario_.gravity_m_s2.z();
    const double most_nm = kRollingResistance * weight_n * lever_m * std::min(1.0, rolling_rad_s / kSoft_rad_s);
    const double inertia_kg_m2 = 0.4 * object.mass_kg * lever_m * lever_m;  // at least
    const double torque_nm = std::min(most_nm, kMostOfRate * inertia_kg_m2 * rolling_rad_s / settings_.step_s);
    dynamics_->add_torque(object_body(i),
                          {-torque_nm * rate.x() / rolling_rad_s, -torque_nm * rate.y() / rolling_rad_s, 0.0});
  }
}

void World::step() {
  for (std::size_t i = 0; i < drives_.size(); ++i) rows_[i] = drives_[i].drive();
  for (std::size_t i = 0; i < object_count(); ++i) dynamics_->add_force(object_body(i), pushes_n_[i]);
  stand_on_bellies();
  resist_rolling();
  contacts_.begin_step();
  collide();
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
