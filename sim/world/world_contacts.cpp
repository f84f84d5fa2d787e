// The contacts that World gives to the solver in each step.
#include "sim/world/world.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

// Neighbouring modules overlap at their joint, and modules two apart may touch at the joints' limits. Neither pair
// makes contacts.
constexpr std::size_t kNearestSelfContact = 3;

}  // namespace

Capsule World::capsule_of(std::size_t module) const {
  const BodyMotion& body = dynamics_->body(module);
  const Vector3d half = 0.5 * robot_.module_length_m * Vector3d(body.R_WB.col(0));
  return {body.position_m + half, body.position_m - half, robot_.module_radius_m};
}

ConvexSolid World::solid_of(std::size_t object) const {
  return {scenario_.objects[object].shape, scenario_.objects[object].size_m, object_pose(object)};
}

void World::collide() {
  const ScenarioFriction& friction = scenario_.friction;
  const Friction holding = Friction::equal(friction.object_robot);
  for (std::size_t i = 0; i < module_count(); ++i) {
    capsules_[i] = capsule_of(i);
    touch_ground(i);
    touch_itself(i);
    const Capsule& capsule = capsules_[i];
    const Vector3d centre = 0.5 * (capsule.front + capsule.back);
    const auto touch = [&](const ConvexSolid& solid, double bound_m, Touched touched, std::size_t index,
                           std::size_t body) {
      const double reach = module_bound_m() + bound_m;
      if ((centre - solid.X_WS.translation()).squaredNorm() > reach * reach) return;
      touches_.clear();
      touch_capsule_solid(capsule, solid, touches_);
      for (std::size_t k = 0; k < touches_.size(); ++k)
        contacts_.add_felt({touches_[k], holding, i, body}, touched, index, k);
    };
    for (std::size_t j = 0; j < obstacles_.size(); ++j)
      touch(obstacles_[j].solid, obstacles_[j].bound_m, Touched::kObstacle, j, kFixed);
    for (std::size_t j = 0; j < object_count(); ++j)
      touch(solid_of(j), object_bound_m_[j], Touched::kObject, j, object_body(j));
  }
  collide_objects();
}

void World::touch_ground(std::size_t module) {
  const Capsule& capsule = capsules_[module];
  // The skin slides easily along the projection of the module's axis on the ground, as it is in the middle of the step.
  // With the axis of the beginning of the step, a module that turns would seem to slide sideways, at its speed times
  // half of the angle by which it turns in the step. Friction would oppose this false motion, and the joints would work
  // against each other: 20 % more torque at 4 ms.
  Vector3d along = capsule.front - capsule.back;
  along += 0.5 * settings_.step_s * dynamics_->body(module).angular_velocity_rad_s.cross(along);
  along.z() = 0.0;
  const double length = along.norm();
  along = length > 1e-6 ? Vector3d(along / length) : Vector3d::UnitX();
  const double scale = scenario_.friction.ground_scale;
  const Friction skin{scale * robot_.friction_along, scale * robot_.friction_across, false, along};
  std::size_t feature = 0;
  for (const Vector3d& end : {capsule.front, capsule.back}) {
    if (feature == 1 && settings_.one_ground_contact_a_joint && module + 1 < module_count()) continue;
    const double depth = capsule.radius_m - end.z();
    if (depth > 0.0) {
      const TouchPoint touch{end - Vector3d(0.0, 0.0, capsule.radius_m), Vector3d::UnitZ(), depth};
      contacts_.add_felt({touch, skin, module, kFixed}, Touched::kGround, 0, feature);
    }
    ++feature;
  }
}

void World::touch_itself(std::size_t module) {
  const Friction rubbing = Friction::equal(scenario_.friction.robot_robot);
  const Capsule& capsule = capsules_[module];
  const Vector3d centre = 0.5 * (capsule.front + capsule.back);
  for (std::size_t j = 0; j + kNearestSelfContact <= module; ++j) {
    const Vector3d other = 0.5 * (capsules_[j].front + capsules_[j].back);
    if ((centre - other).squaredNorm() > 4.0 * module_bound_m() * module_bound_m()) continue;
    touches_.clear();
    touch_capsules(capsule, capsules_[j], touches_);
    for (std::size_t k = 0; k < touches_.size(); ++k)
      contacts_.add_felt({touches_[k], rubbing, module, j}, Touched::kSelf, j, k);
  }
}

void World::collide_objects() {
  const Friction standing = Friction::equal(scenario_.friction.object_ground);
  for (std::size_t i = 0; i < object_count(); ++i) {
    touches_.clear();
    touch_solid_ground(solid_of(i), touches_);
    for (const TouchPoint& touch : touches_) contacts_.add({touch, standing, object_body(i), kFixed});
    const Vector3d centre = dynamics_->body(object_body(i)).position_m;
    for (std::size_t j = 0; j < i; ++j) {
      const double reach = object_bound_m_[i] + object_bound_m_[j];
      if ((centre - dynamics_->body(object_body(j)).position_m).squaredNorm() > reach * reach) continue;
      place_geom(j);
      collide_geoms(object_geoms_[j].get(), i, object_body(j));
    }
    for (const Obstacle& obstacle : obstacles_) {
      const double reach = object_bound_m_[i] + obstacle.bound_m;
      if ((centre - obstacle.solid.X_WS.translation()).squaredNorm() > reach * reach) continue;
      collide_geoms(obstacle.geom.get(), i, kFixed);
    }
  }
}

void World::place_geom(std::size_t object) {
  const BodyMotion& body = dynamics_->body(object_body(object));
  const Eigen::Matrix3d& R = body.R_WB;
  const dMatrix3 rotation = {R(0, 0), R(0, 1), R(0, 2), 0.0,     R(1, 0), R(1, 1),
                             R(1, 2), 0.0,     R(2, 0), R(2, 1), R(2, 2), 0.0};
  const Vector3d& p = body.position_m;
  dGeomSetPosition(object_geoms_[object].get(), p.x(), p.y(), p.z());
  dGeomSetRotation(object_geoms_[object].get(), rotation);
}

void World::collide_geoms(dGeomID other, std::size_t object, std::size_t other_body) {
  place_geom(object);
  dContactGeom found[8];
  const auto vector_of = [](const dReal* from) { return Vector3d(from[0], from[1], from[2]); };
  const int count = dCollide(object_geoms_[object].get(), other, 8, found, sizeof(dContactGeom));
  for (int k = 0; k < count; ++k) {
    const TouchPoint touch{vector_of(found[k].pos), vector_of(found[k].normal), found[k].depth};
    contacts_.add({touch, Friction::equal(scenario_.friction.object_ground), object_body(object), other_body});
  }
}

}  // namespace constrictor
