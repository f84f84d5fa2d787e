#include "sim/render/scene_from_messages.hpp"

namespace constrictor {
namespace {

Eigen::Vector3d vector_of(const msg::Vector3& v) { return {v.x, v.y, v.z}; }

Solid solid_of(std::uint8_t shape, const msg::Vector3& size_m, const Rgb& colour) {
  return {shape == msg::kShapeBox ? SolidShape::kBox : SolidShape::kCylinder, vector_of(size_m), colour};
}

}  // namespace

Eigen::Isometry3d pose_of(const msg::Pose3& pose) {
  const Eigen::Quaterniond q(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = q.toRotationMatrix();
  X.translation() = vector_of(pose.position_m);
  return X;
}

Scene scene_of(const msg::SceneDescription& description) {
  Scene scene;
  scene.module_length_m = description.module_length_m;
  scene.module_radius_m = description.module_radius_m;
  for (std::size_t i = 0; i < description.object_count; ++i) {
    const msg::SceneObject& object = description.objects[i];
    scene.objects.push_back(solid_of(object.shape, object.size_m, colour_reflectance(object.colour)));
  }
  for (std::size_t i = 0; i < description.zone_count; ++i) {
    const msg::SceneZone& zone = description.zones[i];
    scene.zones.push_back({{zone.x_m, zone.y_m}, zone.radius_m, colour_reflectance(zone.colour)});
  }
  for (std::size_t i = 0; i < description.obstacle_count; ++i) {
    const msg::SceneObstacle& obstacle = description.obstacles[i];
    scene.obstacles.push_back(solid_of(obstacle.shape, obstacle.size_m, colour_reflectance(msg::kColourUnknown)));
    scene.X_WObstacle.push_back(pose_of(obstacle.pose));
  }
  for (std::size_t i = 0; i < description.line_point_count; ++i) {
    scene.line_m.emplace_back(description.line_x_m[i], description.line_y_m[i]);
  }
  scene.line_width_m = description.line_width_m;
  scene.line_colour = colour_reflectance(description.line_colour);
  const msg::Vector3& ground = description.ground_colour;
  scene.ground_colour = {static_cast<float>(ground.x), static_cast<float>(ground.y), static_cast<float>(ground.z)};
  scene.ground_gloss = description.ground_gloss;
  scene.light = {vector_of(description.light_direction), description.light_intensity, description.ambient_intensity};
  return scene;
}

ScenePoses poses_of(const msg::WorldState& world) {
  ScenePoses poses;
  for (std::size_t i = 0; i < world.module_count; ++i) poses.X_WModule.push_back(pose_of(world.module_poses[i]));
  for (std::size_t i = 0; i < world.object_count; ++i) poses.X_WObject.push_back(pose_of(world.object_poses[i]));
  return poses;
}

}  // namespace constrictor
