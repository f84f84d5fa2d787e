#include "sim/world/mechanism.hpp"

#include "robot/kinematics.hpp"
#include "sim/world/ode_handles.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

RigidBody body_of(const dMass& mass, const Eigen::Isometry3d& X_WB) {
  return {mass.mass, {mass.I[0], mass.I[5], mass.I[10]}, X_WB};
}

}  // namespace

Eigen::Isometry3d upright_pose(const Eigen::Vector2d& position_m, double height_m, double yaw_rad) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Vector3d(position_m.x(), position_m.y(), height_m);
  return pose;
}

Mechanism mechanism_of(const RobotModel& robot, const Scenario& scenario) {
  Mechanism mechanism;
  mechanism.joints = robot.joints;
  mechanism.half_length_m = 0.5 * robot.module_length_m;
  mechanism.radius_m = robot.module_radius_m;
  mechanism.gravity_m_s2 = scenario.gravity_m_s2;
  dMass mass;
  dMassSetCapsuleTotal(&mass, robot.module_mass_kg, 1, robot.module_radius_m, robot.module_length_m);
  const Eigen::Isometry3d X_WHead =
      upright_pose(scenario.start_m, scenario.start_height_m + robot.module_radius_m, scenario.start_yaw_rad);
  for (const Eigen::Isometry3d& pose : module_poses(robot, {}, X_WHead))
    mechanism.modules.push_back(body_of(mass, pose));
  for (const ScenarioObject& object : scenario.objects) {
    const Vector3d& size = object.size_m;
    if (object.shape == BodyShape::kCylinder) {
      dMassSetCylinderTotal(&mass, object.mass_kg, 3, size.x(), size.z());
    } else {
      dMassSetBoxTotal(&mass, object.mass_kg, size.x(), size.y(), size.z());
    }
    mechanism.objects.push_back(body_of(mass, upright_pose(object.position_m, 0.5 * size.z(), object.yaw_rad)));
  }
  return mechanism;
}

}  // namespace constrictor
