#include "sim/world/world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/kinematics.hpp"
#include "sim/world/ode_eigen.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

void place(dBodyID body, const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const dQuaternion quaternion = {q.w(), q.x(), q.y(), q.z()};
  dBodySetPosition(body, pose.translation().x(), pose.translation().y(), pose.translation().z());
  dBodySetQuaternion(body, quaternion);
}

Eigen::Isometry3d upright(const Eigen::Vector2d& position_m, double height_m, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Vector3d(position_m.x(), position_m.y(), height_m);
  return pose;
}

OdeGeom make_geom(BodyShape shape, const Vector3d& size_m) {
  return OdeGeom(shape == BodyShape::kCylinder ? dCreateCylinder(nullptr, size_m.x(), size_m.z())
                                               : dCreateBox(nullptr, size_m.x(), size_m.y(), size_m.z()));
}

double bound_of(BodyShape shape, const Vector3d& size_m) {
  return shape == BodyShape::kCylinder ? std::hypot(size_m.x(), 0.5 * size_m.z()) : 0.5 * size_m.norm();
}

OdeWorld make_world(const SolverSettings& settings, const Vector3d& gravity_m_s2) {
  ensure_ode();
  OdeWorld world(dWorldCreate());
  dWorldSetGravity(world.get(), gravity_m_s2.x(), gravity_m_s2.y(), gravity_m_s2.z());
  dWorldSetERP(world.get(), settings.erp);
  dWorldSetCFM(world.get(), settings.cfm);
  dWorldSetQuickStepNumIterations(world.get(), settings.iterations);
  dWorldSetQuickStepW(world.get(), settings.over_relaxation);
  dWorldSetContactSurfaceLayer(world.get(), settings.surface_layer_m);
  dWorldSetContactMaxCorrectingVel(world.get(), settings.max_correcting_velocity_m_s);
  return world;
}

}  // namespace

World::World(const RobotModel& robot, const Scenario& scenario, const SolverSettings& settings)
    : robot_(robot),
      scenario_(scenario),
      settings_(settings),
      world_(make_world(settings, scenario.gravity_m_s2)),
      contacts_(world_.get(), settings),
      reorder_state_(settings.reorder_seed) {
  build_robot();
  build_objects();
  build_obstacles();
}

void World::build_robot() {
  dMass mass;
  dMassSetCapsuleTotal(&mass, robot_.module_mass_kg, 1, robot_.module_radius_m, robot_.module_length_m);
  const Eigen::Isometry3d X_WHead =
      upright(scenario_.start_m, scenario_.start_height_m + robot_.module_radius_m, scenario_.start_yaw_rad);
  for (const Eigen::Isometry3d& pose : module_poses(robot_, {}, X_WHead)) {
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    place(body, pose);
    modules_.push_back(body);
  }
  for (std::size_t i = 0; i + 1 < modules_.size(); ++i) {
    const Eigen::Isometry3d X_WM = module_pose(i);
    const Vector3d p_WJ = X_WM * Vector3d(-0.5 * robot_.module_length_m, 0.0, 0.0);
    const Vector3d a_W = X_WM.linear().col(robot_.joints[i].axis == JointAxis::kYaw ? 2 : 1);
    const dVector3 anchor = {p_WJ.x(), p_WJ.y(), p_WJ.z()};
    const dVector3 axis = {a_W.x(), a_W.y(), a_W.z()};
    drives_.push_back(
        std::make_unique<JointDrive>(world_.get(), robot_.joints[i], modules_[i], modules_[i + 1], anchor, axis));
    drives_.back()->set({0.0, 0.0, robot_.joints[i].max_torque_nm});
  }
  capsules_.resize(modules_.size());
}

void World::build_objects() {
  for (const ScenarioObject& object : scenario_.objects) {
    dMass mass;
    const Vector3d& size = object.size_m;
    if (object.shape == BodyShape::kCylinder) {
      dMassSetCylinderTotal(&mass, object.mass_kg, 3, size.x(), size.z());
    } else {
      dMassSetBoxTotal(&mass, object.mass_kg, size.x(), size.y(), size.z());
    }
    const dBodyID body = dBodyCreate(world_.get());
    dBodySetMass(body, &mass);
    place(body, upright(object.position_m, 0.5 * size.z(), object.yaw_rad));
    object_geoms_.push_back(make_geom(object.shape, size));
    dGeomSetBody(object_geoms_.back().get(), body);
    objects_.push_back(body);
    object_bound_m_.push_back(bound_of(object.shape, size));
  }
  forces_n_.assign(objects_.size(), Vector3d::Zero());
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
    drives_[i]->set({position_rad[i], velocity_rad_s[i], torque_limit_nm[i]});
  }
}

void World::set_servo(std::span<const JointSetpoint> setpoints) {
  if (setpoints.size() != drives_.size())
    throw std::invalid_argument(fmt::format("World::set_servo: found {} setpoints, accepted {} (one for each joint)",
                                            setpoints.size(), drives_.size()));
  for (std::size_t i = 0; i < drives_.size(); ++i) drives_[i]->set(setpoints[i]);
}

void World::apply_force(std::size_t object, const Vector3d& force_n) { forces_n_.at(object) += force_n; }

void World::move_object(std::size_t object, const Eigen::Vector2d& by_m) {
  const dBodyID body = objects_.at(object);
  const dReal* p = dBodyGetPosition(body);
  dBodySetPosition(body, p[0] + by_m.x(), p[1] + by_m.y(), p[2]);
  dBodySetLinearVel(body, 0, 0, 0);
  dBodySetAngularVel(body, 0, 0, 0);
}

void World::advance(double duration_s, const std::function<void()>& after_step) {
  const auto count = std::max<std::int64_t>(1, std::llround(duration_s / settings_.step_s));
  const Vector3d velocity_before = module_velocity_m_s(0);
  contacts_.begin_tick();
  for (const auto& drive : drives_) drive->begin_tick(static_cast<int>(count), settings_.step_s);
  for (std::int64_t i = 0; i < count; ++i) {
    step();
    if (after_step) after_step();
  }
  acceleration_m_s2_ = (module_velocity_m_s(0) - velocity_before) / (static_cast<double>(count) * settings_.step_s);
  std::fill(forces_n_.begin(), forces_n_.end(), Vector3d::Zero());
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
  for (const dBodyID body : modules_) {
    const dReal* R = dBodyGetRotation(body);
    const double roll_rad = std::atan2(R[9], R[10]);
    if (std::abs(roll_rad) > kTipped_rad || dBodyGetPosition(body)[2] > robot_.module_radius_m + kNear_m) continue;
    const double rate_rad_s = vector_of(dBodyGetAngularVel(body)).dot(Vector3d(R[0], R[4], R[8]));
    const double share = std::clamp((roll_rad + kDamping_s * rate_rad_s) / kSoft_rad, -1.0, 1.0);
    dBodyAddRelTorque(body, -most_nm * share, 0.0, 0.0);
  }
}

// Without it, a cylinder that was knocked over would roll on for ever. The torque grows linearly with slow rates, and
// never takes more than half of a rate in one step, because more would excite it.
void World::resist_rolling() {
  constexpr double kSoft_rad_s = 0.05;
  constexpr double kMostOfRate = 0.5;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const ScenarioObject& object = scenario_.objects[i];
    const Vector3d rate = vector_of(dBodyGetAngularVel(objects_[i]));
    const double rolling_rad_s = std::hypot(rate.x(), rate.y());
    if (rolling_rad_s < 1e-9) continue;
    const double lever_m = object.shape == BodyShape::kCylinder ? object.size_m.x() : 0.5 * object.size_m.minCoeff();
    const double weight_n = object.mass_kg * -scenario_.gravity_m_s2.z();
    const double most_nm = kRollingResistance * weight_n * lever_m * std::min(1.0, rolling_rad_s / kSoft_rad_s);
    const double inertia_kg_m2 = 0.4 * object.mass_kg * lever_m * lever_m;  // at least
    const double torque_nm = std::min(most_nm, kMostOfRate * inertia_kg_m2 * rolling_rad_s / settings_.step_s);
    dBodyAddTorque(objects_[i], -torque_nm * rate.x() / rolling_rad_s, -torque_nm * rate.y() / rolling_rad_s, 0.0);
  }
}

void World::step() {
  for (const auto& drive : drives_) drive->drive();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    dBodyAddForce(objects_[i], forces_n_[i].x(), forces_n_[i].y(), forces_n_[i].z());
  }
  stand_on_bellies();
  resist_rolling();
  contacts_.begin_step();
  collide();
  // QuickStep reorders constraints with a random generator that all worlds of the process share. Each world restores
  // its own sequence, so that worlds in one process do not influence each other.
  dRandSetSeed(reorder_state_);
  if (dWorldQuickStep(world_.get(), settings_.step_s) == 0)
    throw std::runtime_error("ODE: dWorldQuickStep failed: out of memory");
  reorder_state_ = dRandGetSeed();
  contacts_.collect();
  for (const auto& drive : drives_) drive->measure(settings_.step_s, robot_.torque_filter_s);
  ++steps_done_;
}

Eigen::Isometry3d World::module_pose(std::size_t module) const { return pose_of(modules_[module]); }
Vector3d World::module_velocity_m_s(std::size_t module) const { return vector_of(dBodyGetLinearVel(modules_[module])); }
Vector3d World::module_angular_velocity_rad_s(std::size_t module) const {
  return vector_of(dBodyGetAngularVel(modules_[module]));
}
Eigen::Isometry3d World::object_pose(std::size_t object) const { return pose_of(objects_[object]); }
Vector3d World::object_velocity_m_s(std::size_t object) const { return vector_of(dBodyGetLinearVel(objects_[object])); }
Vector3d World::object_angular_velocity_rad_s(std::size_t object) const {
  return vector_of(dBodyGetAngularVel(objects_[object]));
}

ImuTruth World::imu() const {
  ImuTruth imu;
  imu.q_WHead = quaternion_of(modules_[0]);
  const Eigen::Matrix3d R_HeadW = module_pose(0).linear().transpose();
  imu.angular_velocity_rad_s = R_HeadW * module_angular_velocity_rad_s(0);
  imu.proper_acceleration_m_s2 = R_HeadW * (acceleration_m_s2_ + (Vector3d::Zero() - scenario_.gravity_m_s2));
  if (scenario_.gravity_m_s2.norm() > 0.0) imu.up_W = -scenario_.gravity_m_s2.normalized();
  return imu;
}

void World::extend_hash() {
  hash_values_.clear();
  const auto append = [this](const dReal* values, int count) {
    hash_values_.insert(hash_values_.end(), values, values + count);
  };
  for (const auto* bodies : {&modules_, &objects_}) {
    for (const dBodyID body : *bodies) {
      append(dBodyGetPosition(body), 3);
      append(dBodyGetQuaternion(body), 4);
      append(dBodyGetLinearVel(body), 3);
      append(dBodyGetAngularVel(body), 3);
    }
  }
  for (const auto& drive : drives_) {
    hash_values_.push_back(drive->angle_rad());
    hash_values_.push_back(drive->rate_rad_s());
  }
  hash_.extend(hash_values_);
}

}  // namespace constrictor
