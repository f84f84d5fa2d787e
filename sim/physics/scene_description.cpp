#include "sim/physics/scene_description.hpp"

#include <algorithm>
#include <cmath>

#include "robot/pose_message.hpp"

namespace constrictor {
namespace {

static_assert(static_cast<std::uint8_t>(BodyShape::kCylinder) == msg::kShapeCylinder);
static_assert(static_cast<std::uint8_t>(BodyShape::kBox) == msg::kShapeBox);

}  // namespace

msg::SceneDescription scene_description(const Scenario& scenario, const RobotModel& robot) {
  msg::SceneDescription scene{};
  const std::size_t letters = std::min(scenario.name.size(), sizeof(scene.scenario) - 1);
  std::copy_n(scenario.name.begin(), letters, scene.scenario);
  scene.seed = scenario.seed;
  scene.module_count = static_cast<std::uint16_t>(robot.module_count);
  scene.module_length_m = robot.module_length_m;
  scene.module_radius_m = robot.module_radius_m;
  for (const ScenarioObject& object : scenario.objects) {
    scene.objects[scene.object_count++] = {object.colour, static_cast<std::uint8_t>(object.shape),
                                           vector3(object.size_m), object.mass_kg};
  }
  for (const ScenarioZone& zone : scenario.zones) {
    scene.zones[scene.zone_count++] = {zone.colour, zone.position_m.x(), zone.position_m.y(), zone.radius_m};
  }
  for (const ScenarioObstacle& obstacle : scenario.obstacles) {
    msg::SceneObstacle& to = scene.obstacles[scene.obstacle_count++];
    to.shape = static_cast<std::uint8_t>(obstacle.shape);
    to.size_m = vector3(obstacle.size_m);
    to.pose.position_m = {obstacle.position_m.x(), obstacle.position_m.y(), 0.5 * obstacle.size_m.z()};
    to.pose.orientation = {std::cos(0.5 * obstacle.yaw_rad), 0.0, 0.0, std::sin(0.5 * obstacle.yaw_rad)};
  }
  scene.line_colour = scenario.line_m.empty() ? static_cast<std::uint8_t>(msg::kColourUnknown) : scenario.line_colour;
  scene.line_width_m = scenario.line_width_m;
  for (const Eigen::Vector2d& point : scenario.line_m) {
    scene.line_x_m[scene.line_point_count] = point.x();
    scene.line_y_m[scene.line_point_count++] = point.y();
  }
  scene.light_direction = vector3(scenario.light.direction);
  scene.light_intensity = scenario.light.intensity;
  scene.ambient_intensity = scenario.light.ambient;
  scene.camera_noise_sd = scenario.camera_noise_sd;
  scene.ground_colour = vector3(scenario.ground_colour);
  scene.ground_gloss = scenario.ground_gloss;
  return scene;
}

}  // namespace constrictor
