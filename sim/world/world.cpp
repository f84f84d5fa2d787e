#include "sim/world/world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/kinematics.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

// Neighbours overlap at their joint, and the next but one may touch at the joints' limits: no contact among those.
constexpr std::size_t kNearestSelfContact = 3;

Vector3d vector_of(const dReal* from) { return {from[0], from[1], from[2]}; }

Eigen::Quaterniond quaternion_of(dBodyID body) {
  const dReal* q = dBodyGetQuaternion(body);
  return {q[0], q[1], q[2], q[3]};
}

Eigen::Isometry3d pose_of(dBodyID body) {
  const dReal* R = dBodyGetRotation(body);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix().topRows<3>() << R[0], R[1], R[2], 0.0, R[4], R[5], R[6], 0.0, R[8], R[9], R[10], 0.0;
  pose.translation() = vector_of(dBodyGetPosition(body));
  return pose;
}

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

OdeWorld make_world(const SolverSettings& settings) {
  ensure_ode();
  OdeWorld world(dWorldCreate());
  dWorldSetGravity(world.get(), 0.0, 0.0, -World::kGravity_m_s2);
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
      world_(make_world(settings)),
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
    throw std::invalid_argument("World::set_servo: one entry for each joint is needed");
  }
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    drives_[i]->set({position_rad[i], velocity_rad_s[i], torque_limit_nm[i]});
  }
}

void World::apply_force(std::size_t object, const Vector3d& force_n) { forces_n_.at(object) += force_n; }

void World::advance(double duration_s) {
  const auto count = std::max<std::int64_t>(1, std::llround(duration_s / settings_.step_s));
  const Vector3d velocity_before = module_velocity_m_s(0);
  contacts_.begin_tick();
  for (std::int64_t i = 0; i < count; ++i) step();
  acceleration_m_s2_ = (module_velocity_m_s(0) - velocity_before) / (static_cast<double>(count) * settings_.step_s);
  std::fill(forces_n_.begin(), forces_n_.end(), Vector3d::Zero());
  extend_hash();
}

// A flat underside of half-width w resists rolling with up to weight times w. Its edge is softened over a small angle; tipped by
// more than half a right angle a module rests on its round flank.
void World::stand_on_bellies() {
  constexpr double kSoft_rad = 0.05;
  constexpr double kTipped_rad = 0.8;
  constexpr double kDamping_s = 0.01;
  constexpr double kNear_m = 0.01;
  const double most_nm = robot_.module_mass_kg * kGravity_m_s2 * robot_.module_belly_half_width_m;
  if (most_nm == 0.0) return;
  for (const dBodyID body : modules_) {
    const dReal* R = dBodyGetRotation(body);
    const double roll_rad = std::atan2(R[9], R[10]);
    if (std::abs(roll_rad) > kTipped_rad || dBodyGetPosition(body)[2] > robot_.module_radius_m + kNear_m) continue;
    const double rate_rad_s = vector_of(dBodyGetAngularVel(body)).dot(Vector3d(R[0], R[4], R[8]));
    const double share = std::clamp((roll_rad + kDamping_s * rate_rad_s) / kSoft_rad, -1.0, 1.0);
    dBodyAddRelTorque(body, -most_nm * share, 0.0, 0.0);
  }
}

void World::step() {
  for (const auto& drive : drives_) drive->drive(settings_.step_s);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    dBodyAddForce(objects_[i], forces_n_[i].x(), forces_n_[i].y(), forces_n_[i].z());
  }
  stand_on_bellies();
  contacts_.begin_step();
  collide();
  // QuickStep reorders constraints by a generator that all worlds of the process share: each continues its own sequence.
  dRandSetSeed(reorder_state_);
  if (dWorldQuickStep(world_.get(), settings_.step_s) == 0) throw std::runtime_error("ODE: out of memory");
  reorder_state_ = dRandGetSeed();
  contacts_.collect();
  for (const auto& drive : drives_) drive->measure(settings_.step_s, robot_.torque_filter_s);
  ++steps_done_;
}

Capsule World::capsule_of(std::size_t module) const {
  const dReal* R = dBodyGetRotation(modules_[module]);
  const Vector3d centre = vector_of(dBodyGetPosition(modules_[module]));
  const Vector3d half = 0.5 * robot_.module_length_m * Vector3d(R[0], R[4], R[8]);
  return {centre + half, centre - half, robot_.module_radius_m};
}

ConvexSolid World::solid_of(std::size_t object) const {
  return {scenario_.objects[object].shape, scenario_.objects[object].size_m, pose_of(objects_[object])};
}

void World::collide() {
  const double module_bound_m = 0.5 * robot_.module_length_m + robot_.module_radius_m;
  const ScenarioFriction& friction = scenario_.friction;
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    capsules_[i] = capsule_of(i);
    const Capsule& capsule = capsules_[i];
    const auto module = static_cast<std::uint8_t>(i);
    // The skin: its easy direction is the module's axis along the ground.
    Vector3d along = capsule.front - capsule.back;
    along.z() = 0.0;
    const double length = along.norm();
    along = length > 1e-6 ? Vector3d(along / length) : Vector3d::UnitX();
    const Friction skin{friction.ground_scale * robot_.friction_along, friction.ground_scale * robot_.friction_across, &along};
    std::uint8_t feature = 0;
    for (const Vector3d& end : {capsule.front, capsule.back}) {
      if (feature == 1 && settings_.one_ground_contact_a_joint && i + 1 < modules_.size()) continue;
      const double depth = capsule.radius_m - end.z();
      if (depth > 0.0) {
        const TouchPoint touch{end - Vector3d(0.0, 0.0, capsule.radius_m), Vector3d::UnitZ(), depth};
        contacts_.add_felt(touch, skin, modules_[i], nullptr, module, Touched::kGround, 0, feature);
      }
      ++feature;
    }
    const Vector3d centre = 0.5 * (capsule.front + capsule.back);
    const Friction rubbing{friction.robot_robot, 0.0, nullptr};
    for (std::size_t j = 0; j + kNearestSelfContact <= i; ++j) {
      const Vector3d other = 0.5 * (capsules_[j].front + capsules_[j].back);
      if ((centre - other).squaredNorm() > 4.0 * module_bound_m * module_bound_m) continue;
      touches_.clear();
      touch_capsules(capsule, capsules_[j], touches_);
      for (std::size_t k = 0; k < touches_.size(); ++k) {
        contacts_.add_felt(touches_[k], rubbing, modules_[i], modules_[j], module, Touched::kSelf,
                           static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k));
      }
    }
    const Friction holding{friction.object_robot, 0.0, nullptr};
    for (std::size_t j = 0; j < obstacles_.size(); ++j) {
      const double reach = module_bound_m + obstacles_[j].bound_m;
      if ((centre - obstacles_[j].solid.X_WS.translation()).squaredNorm() > reach * reach) continue;
      touches_.clear();
      touch_capsule_solid(capsule, obstacles_[j].solid, touches_);
      for (std::size_t k = 0; k < touches_.size(); ++k) {
        contacts_.add_felt(touches_[k], holding, modules_[i], nullptr, module, Touched::kObstacle,
                           static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k));
      }
    }
    for (std::size_t j = 0; j < objects_.size(); ++j) {
      const double reach = module_bound_m + object_bound_m_[j];
      if ((centre - vector_of(dBodyGetPosition(objects_[j]))).squaredNorm() > reach * reach) continue;
      touches_.clear();
      touch_capsule_solid(capsule, solid_of(j), touches_);
      for (std::size_t k = 0; k < touches_.size(); ++k) {
        contacts_.add_felt(touches_[k], holding, modules_[i], objects_[j], module, Touched::kObject,
                           static_cast<std::uint8_t>(j), static_cast<std::uint8_t>(k));
      }
    }
  }
  collide_objects();
}

void World::collide_objects() {
  const Friction standing{scenario_.friction.object_ground, 0.0, nullptr};
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    touches_.clear();
    touch_solid_ground(solid_of(i), touches_);
    for (const TouchPoint& touch : touches_) contacts_.add(touch, standing, objects_[i], nullptr);
    const Vector3d centre = vector_of(dBodyGetPosition(objects_[i]));
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = object_bound_m_[i] + object_bound_m_[j];
      if ((centre - vector_of(dBodyGetPosition(objects_[j]))).squaredNorm() > reach * reach) continue;
      collide_geoms(object_geoms_[i].get(), objects_[i], object_geoms_[j].get(), objects_[j]);
    }
    for (const Obstacle& obstacle : obstacles_) {
      const double reach = object_bound_m_[i] + obstacle.bound_m;
      if ((centre - obstacle.solid.X_WS.translation()).squaredNorm() > reach * reach) continue;
      collide_geoms(object_geoms_[i].get(), objects_[i], obstacle.geom.get(), nullptr);
    }
  }
}

void World::collide_geoms(dGeomID first, dBodyID first_body, dGeomID second, dBodyID second_body) {
  dContactGeom found[8];
  const int count = dCollide(first, second, 8, found, sizeof(dContactGeom));
  for (int k = 0; k < count; ++k) {
    const TouchPoint touch{vector_of(found[k].pos), vector_of(found[k].normal), found[k].depth};
    contacts_.add(touch, {scenario_.friction.object_ground, 0.0, nullptr}, first_body, second_body);
  }
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
  imu.proper_acceleration_m_s2 = R_HeadW * (acceleration_m_s2_ + Vector3d(0.0, 0.0, kGravity_m_s2));
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
