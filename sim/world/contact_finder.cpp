#include "sim/world/contact_finder.hpp"

#include <cmath>
#include <utility>

#include "sim/world/mechanism.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

OdeGeom make_geom(BodyShape shape, const Vector3d& size_m) {
  ensure_ode();
  return OdeGeom(shape == BodyShape::kCylinder ? dCreateCylinder(nullptr, size_m.x(), size_m.z())
                                               : dCreateBox(nullptr, size_m.x(), size_m.y(), size_m.z()));
}

double bound_of(BodyShape shape, const Vector3d& size_m) {
  return shape == BodyShape::kCylinder ? std::hypot(size_m.x(), 0.5 * size_m.z()) : 0.5 * size_m.norm();
}

}  // namespace

ContactFinder::ContactFinder(const RobotModel& robot, const Scenario& scenario, const SolverSettings& settings)
    : robot_(robot),
      scenario_(scenario),
      one_ground_contact_a_joint_(settings.one_ground_contact_a_joint),
      step_s_(settings.step_s),
      capsules_(robot.module_count) {
  build_objects();
  build_obstacles();
}

void ContactFinder::build_objects() {
  for (const ScenarioObject& object : scenario_.objects) {
    object_geoms_.push_back(make_geom(object.shape, object.size_m));
    object_bound_m_.push_back(bound_of(object.shape, object.size_m));
  }
}

void ContactFinder::build_obstacles() {
  for (const ScenarioObstacle& obstacle : scenario_.obstacles) {
    Obstacle built;
    built.solid = {obstacle.shape, obstacle.size_m,
                   upright_pose(obstacle.position_m, 0.5 * obstacle.size_m.z(), obstacle.yaw_rad)};
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

Capsule ContactFinder::capsule_of(const BodyMotion& module) const {
  const Vector3d half = 0.5 * robot_.module_length_m * Vector3d(module.R_WB.col(0));
  return {module.position_m + half, module.position_m - half, robot_.module_radius_m};
}

ConvexSolid ContactFinder::solid_of(const Dynamics& dynamics, std::size_t object) const {
  return {scenario_.objects[object].shape, scenario_.objects[object].size_m, dynamics.body(object_body(object)).pose()};
}

void ContactFinder::find(const Dynamics& dynamics, ContactSet& contacts) {
  for (std::size_t i = 0; i < robot_.module_count; ++i) {
    capsules_[i] = capsule_of(dynamics.body(i));
    touch_ground(dynamics, i, contacts);
    touch_itself(i, contacts);
    touch_solids(dynamics, i, contacts);
  }
  collide_objects(dynamics, contacts);
}

void ContactFinder::touch_solids(const Dynamics& dynamics, std::size_t module, ContactSet& contacts) {
  const Friction holding = Friction::equal(scenario_.friction.object_robot);
  const Capsule& capsule = capsules_[module];
  const Vector3d centre = 0.5 * (capsule.front + capsule.back);
  const auto touch = [&](const ConvexSolid& solid, double bound_m, Touched touched, std::size_t index,
                         std::size_t body) {
    const double reach = module_bound_m() + bound_m;
    if ((centre - solid.X_WS.translation()).squaredNorm() > reach * reach) return;
    touches_.clear();
    touch_capsule_solid(capsule, solid, touches_);
    for (std::size_t k = 0; k < touches_.size(); ++k)
      contacts.add_felt({touches_[k], holding, module, body}, touched, index, k);
  };
  for (std::size_t j = 0; j < obstacles_.size(); ++j)
    touch(obstacles_[j].solid, obstacles_[j].bound_m, Touched::kObstacle, j, kFixed);
  for (std::size_t j = 0; j < object_count(); ++j)
    touch(solid_of(dynamics, j), object_bound_m_[j], Touched::kObject, j, object_body(j));
}

void ContactFinder::touch_ground(const Dynamics& dynamics, std::size_t module, ContactSet& contacts) {
  const Capsule& capsule = capsules_[module];
  // The skin slides easily along the projection of the module's axis on the ground, as it is in the middle of the step.
  // With the axis of the beginning of the step, a module that turns would seem to slide sideways, at its speed times
  // half of the angle by which it turns in the step. Friction would oppose this false motion, and the joints would work
  // against each other: 20 % more torque at 4 ms.
  Vector3d along = capsule.front - capsule.back;
  along += 0.5 * step_s_ * dynamics.body(module).angular_velocity_rad_s.cross(along);
  along.z() = 0.0;
  const double length = along.norm();
  along = length > 1e-6 ? Vector3d(along / length) : Vector3d::UnitX();
  const double scale = scenario_.friction.ground_scale;
  const Friction skin{scale * robot_.friction_along, scale * robot_.friction_across, false, along};
  std::size_t feature = 0;
  for (const Vector3d& end : {capsule.front, capsule.back}) {
    if (feature == 1 && one_ground_contact_a_joint_ && module + 1 < robot_.module_count) continue;
    const double depth = capsule.radius_m - end.z();
    if (depth > 0.0) {
      const TouchPoint touch{end - Vector3d(0.0, 0.0, capsule.radius_m), Vector3d::UnitZ(), depth};
      contacts.add_felt({touch, skin, module, kFixed}, Touched::kGround, 0, feature);
    }
    ++feature;
  }
}

void ContactFinder::touch_itself(std::size_t module, ContactSet& contacts) {
  const Friction rubbing = Friction::equal(scenario_.friction.robot_robot);
  const Capsule& capsule = capsules_[module];
  const Vector3d centre = 0.5 * (capsule.front + capsule.back);
  for (std::size_t j = 0; j + kNearestSelfContact <= module; ++j) {
    const Vector3d other = 0.5 * (capsules_[j].front + capsules_[j].back);
    if ((centre - other).squaredNorm() > 4.0 * module_bound_m() * module_bound_m()) continue;
    touches_.clear();
    touch_capsules(capsule, capsules_[j], touches_);
    for (std::size_t k = 0; k < touches_.size(); ++k)
      contacts.add_felt({touches_[k], rubbing, module, j}, Touched::kSelf, j, k);
  }
}

void ContactFinder::collide_objects(const Dynamics& dynamics, ContactSet& contacts) {
  const Friction standing = Friction::equal(scenario_.friction.object_ground);
  for (std::size_t i = 0; i < object_count(); ++i) {
    touches_.clear();
    touch_solid_ground(solid_of(dynamics, i), touches_);
    for (const TouchPoint& touch : touches_) contacts.add({touch, standing, object_body(i), kFixed});
    const Vector3d centre = dynamics.body(object_body(i)).position_m;
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = object_bound_m_[i] + object_bound_m_[j];
      if ((centre - dynamics.body(object_body(j)).position_m).squaredNorm() > reach * reach) continue;
      place_geom(dynamics, i);
      place_geom(dynamics, j);
      collide_geoms(object_geoms_[j].get(), i, object_body(j), contacts);
    }
    for (const Obstacle& obstacle : obstacles_) {
      const double reach = object_bound_m_[i] + obstacle.bound_m;
      if ((centre - obstacle.solid.X_WS.translation()).squaredNorm() > reach * reach) continue;
      place_geom(dynamics, i);
      collide_geoms(obstacle.geom.get(), i, kFixed, contacts);
    }
  }
}

void ContactFinder::place_geom(const Dynamics& dynamics, std::size_t object) {
  const BodyMotion& body = dynamics.body(object_body(object));
  const Eigen::Matrix3d& R = body.R_WB;
  const dMatrix3 rotation = {R(0, 0), R(0, 1), R(0, 2), 0.0,     R(1, 0), R(1, 1),
                             R(1, 2), 0.0,     R(2, 0), R(2, 1), R(2, 2), 0.0};
  const Vector3d& p = body.position_m;
  dGeomSetPosition(object_geoms_[object].get(), p.x(), p.y(), p.z());
  dGeomSetRotation(object_geoms_[object].get(), rotation);
}

void ContactFinder::collide_geoms(dGeomID other, std::size_t object, std::size_t other_body, ContactSet& contacts) {
  dContactGeom found[8];
  const auto vector_of = [](const dReal* from) { return Vector3d(from[0], from[1], from[2]); };
  const int count = dCollide(object_geoms_[object].get(), other, 8, found, sizeof(dContactGeom));
  for (int k = 0; k < count; ++k) {
    const TouchPoint touch{vector_of(found[k].pos), vector_of(found[k].normal), found[k].depth};
    contacts.add({touch, Friction::equal(scenario_.friction.object_ground), object_body(object), other_body});
  }
}

}  // namespace constrictor
