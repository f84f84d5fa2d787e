// The contacts that World gives to the solver in each step.
#include "sim/world/ode_eigen.hpp"
#include "sim/world/world.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

// Neighbouring modules overlap at their joint, and modules two apart may touch at the joints' limits. Neither pair
// makes contacts.
constexpr std::size_t kNearestSelfContact = 3;

}  // namespace

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
    // The skin slides easily along the projection of the module's axis on the ground.
    Vector3d along = capsule.front - capsule.back;
    along.z() = 0.0;
    const double length = along.norm();
    along = length > 1e-6 ? Vector3d(along / length) : Vector3d::UnitX();
    const Friction skin{friction.ground_scale * robot_.friction_along, friction.ground_scale * robot_.friction_across,
                        &along};
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

}  // namespace constrictor
