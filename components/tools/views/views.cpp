#include "views/views.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"
#include "robot/planar_message.hpp"
#include "robot/rotation.hpp"
#include "views/foxglove_json.hpp"

namespace constrictor::views {
namespace {

using nlohmann::json;

constexpr double kFullTorque_nm = 5.0;   // shown in the strongest colour
constexpr double kArrow_m_per_n = 0.02;  // length of the arrow of a contact force
constexpr double kFlat_m = 0.004;        // height of what lies on the ground

/// From grey (no torque) to blue (negative) or orange (positive).
json torque_colour(double torque_nm) {
  const double share = std::clamp(torque_nm / kFullTorque_nm, -1.0, 1.0);
  const double s = std::abs(share);
  const std::array<double, 3> full = share < 0 ? std::array{0.0, 0.45, 0.7} : std::array{0.84, 0.37, 0.0};
  return colour(0.62 + s * (full[0] - 0.62), 0.62 + s * (full[1] - 0.62), 0.62 + s * (full[2] - 0.62));
}

Eigen::Vector3d rotated(const msg::Quaternion& q, const msg::Vector3& v) {
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z) * Eigen::Vector3d(v.x, v.y, v.z);
}

json entity(const char* id, std::uint64_t time_ns) {
  return {{"timestamp", stamp(time_ns)},
          {"frame_id", "world"},
          {"id", id},
          {"lifetime", {{"sec", 0}, {"nsec", 0}}},
          {"frame_locked", false},
          {"metadata", json::array()},
          {"arrows", json::array()},
          {"cubes", json::array()},
          {"spheres", json::array()},
          {"cylinders", json::array()},
          {"lines", json::array()},
          {"triangles", json::array()},
          {"texts", json::array()},
          {"models", json::array()}};
}

json cylinder(json pose, double radius_m, double height_m, json paint) {
  return {{"pose", std::move(pose)},
          {"size", point(2 * radius_m, 2 * radius_m, height_m)},
          {"bottom_scale", 1.0},
          {"top_scale", 1.0},
          {"color", std::move(paint)}};
}

json cube(json pose, const msg::Vector3& size, json paint) {
  return {{"pose", std::move(pose)}, {"size", point(size.x, size.y, size.z)}, {"color", std::move(paint)}};
}

json scenery(const msg::SceneDescription& scene, std::uint64_t time_ns) {
  json ground = entity("scenery", time_ns);
  json points = json::array();
  for (std::size_t i = 0; i < scene.line_point_count; ++i)
    points.push_back(point(scene.line_x_m[i], scene.line_y_m[i], kFlat_m));
  ground["lines"].push_back({{"type", 0},
                             {"pose", pose_of(0, 0, 0)},
                             {"thickness", scene.line_width_m},
                             {"scale_invariant", false},
                             {"points", points},
                             {"color", colour_of(scene.line_colour)},
                             {"colors", json::array()},
                             {"indices", json::array()}});
  for (std::size_t i = 0; i < scene.zone_count; ++i) {
    const msg::SceneZone& zone = scene.zones[i];
    ground["cylinders"].push_back(
        cylinder(pose_of(zone.x_m, zone.y_m, kFlat_m / 2), zone.radius_m, kFlat_m, colour_of(zone.colour, 0.5)));
  }
  for (std::size_t i = 0; i < scene.obstacle_count; ++i) {
    const msg::SceneObstacle& obstacle = scene.obstacles[i];
    if (obstacle.shape == msg::kShapeBox)
      ground["cubes"].push_back(cube(pose_of(obstacle.pose), obstacle.size_m, colour(0.4, 0.4, 0.4)));
    else
      ground["cylinders"].push_back(
          cylinder(pose_of(obstacle.pose), obstacle.size_m.x, obstacle.size_m.z, colour(0.4, 0.4, 0.4)));
  }
  return ground;
}

json objects(const msg::SceneDescription& scene, const msg::WorldState& world, std::uint64_t time_ns) {
  json list = entity("objects", time_ns);
  for (std::size_t i = 0; i < std::min(scene.object_count, world.object_count); ++i) {
    const msg::SceneObject& object = scene.objects[i];
    const json pose = pose_of(world.object_poses[i]);
    if (object.shape == msg::kShapeBox) list["cubes"].push_back(cube(pose, object.size_m, colour_of(object.colour)));
    else list["cylinders"].push_back(cylinder(pose, object.size_m.x, object.size_m.z, colour_of(object.colour)));
  }
  return list;
}

json robot(const Newest& newest, std::uint64_t time_ns) {
  json list = entity("robot", time_ns);
  const msg::WorldState& world = *newest.world;
  const msg::Vector3 size{newest.scene->module_length_m, 2 * newest.scene->module_radius_m,
                          2 * newest.scene->module_radius_m};
  for (std::size_t i = 0; i < world.module_count; ++i) {
    // The colour of a module is that of the joint behind it.
    const bool known = newest.joints && i < newest.joints->joint_count;
    list["cubes"].push_back(
        cube(pose_of(world.module_poses[i]), size, torque_colour(known ? newest.joints->torque_nm[i] : 0.0)));
  }
  for (const ContactArrow& arrow : contact_arrows(newest)) {
    const auto q = shortest_rotation(Eigen::Vector3d::UnitX(), arrow.force_W_n);
    list["arrows"].push_back({{"pose",
                               {{"position", point(arrow.p_W.x(), arrow.p_W.y(), arrow.p_W.z())},
                                {"orientation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}}},
                              {"shaft_length", kArrow_m_per_n * arrow.force_W_n.norm()},
                              {"shaft_diameter", 0.01},
                              {"head_length", 0.03},
                              {"head_diameter", 0.03},
                              {"color", colour(0.8, 0.1, 0.5)}});
  }
  return list;
}

json own_map(const Newest& newest, std::uint64_t time_ns) {
  json list = entity("robot's own map", time_ns);
  for (std::size_t i = 0; i < newest.map->object_count; ++i) {
    const msg::MapObject& object = newest.map->objects[i];
    const Eigen::Vector2d p = newest.start->to_parent({object.x_m, object.y_m});
    const double radius_m = std::isfinite(object.radius_m) ? object.radius_m : 0.05;
    const bool zone = object.kind == msg::kBlobZone;
    const double height_m = zone ? kFlat_m : std::isfinite(object.height_m) ? object.height_m : 0.2;
    list["cylinders"].push_back(cylinder(pose_of(p.x(), p.y(), zone ? kFlat_m : 0.5 * height_m), radius_m, height_m,
                                         colour_of(object.colour, 0.3)));
  }
  constexpr double kPeg_m = 0.02, kPegHeight_m = 0.12;  // what stands at a point of an obstacle
  for (std::size_t i = 0; i < newest.map->obstacle_count; ++i) {
    const Eigen::Vector2d p = newest.start->to_parent({newest.map->obstacle_x_m[i], newest.map->obstacle_y_m[i]});
    list["cylinders"].push_back(
        cylinder(pose_of(p.x(), p.y(), 0.5 * kPegHeight_m), kPeg_m, kPegHeight_m, colour(0.7, 0.25, 0.55)));
  }
  return list;
}

}  // namespace

std::vector<ContactArrow> contact_arrows(const Newest& newest) {
  std::vector<ContactArrow> arrows;
  if (!newest.contacts || !newest.world) return arrows;
  for (std::size_t i = 0; i < newest.contacts->contact_count; ++i) {
    const msg::Contact& contact = newest.contacts->contacts[i];
    if (contact.module_index >= newest.world->module_count) continue;
    const msg::Pose3& module = newest.world->module_poses[contact.module_index];
    const Eigen::Vector3d force_n = rotated(module.orientation, contact.force_n);
    if (force_n.head<2>().norm() < 0.5) continue;
    arrows.push_back({Eigen::Vector3d(module.position_m.x, module.position_m.y, module.position_m.z) +
                          rotated(module.orientation, contact.position_m),
                      force_n});
  }
  return arrows;
}

json scene_update(const Newest& newest, std::uint64_t time_ns) {
  json entities = json::array();
  if (newest.scene) entities.push_back(scenery(*newest.scene, time_ns));
  if (newest.scene && newest.world) {
    entities.push_back(objects(*newest.scene, *newest.world, time_ns));
    entities.push_back(robot(newest, time_ns));
  }
  if (newest.map && newest.start) entities.push_back(own_map(newest, time_ns));
  return {{"deletions", json::array()}, {"entities", entities}};
}

json frame_transforms(const Newest& newest, std::uint64_t time_ns) {
  json list = json::array();
  const auto add = [&](const char* child, const json& pose, const char* parent = "world") {
    list.push_back({{"timestamp", stamp(time_ns)},
                    {"parent_frame_id", parent},
                    {"child_frame_id", child},
                    {"translation", pose["position"]},
                    {"rotation", pose["orientation"]}});
  };
  if (newest.world && newest.world->module_count > 0) add("head", pose_of(newest.world->module_poses[0]));
  if (newest.camera) add("camera", pose_of(newest.camera->X_HC), "head");
  if (newest.start) {
    add("start", pose_of(newest.start->p.x(), newest.start->p.y(), 0, newest.start->yaw_rad));
    if (newest.pose) {
      const Eigen::Vector2d p = newest.start->to_parent({newest.pose->x_m, newest.pose->y_m});
      add("estimated head", pose_of(p.x(), p.y(), 0, newest.start->yaw_rad + newest.pose->yaw_rad));
    }
  }
  return {{"transforms", list}};
}

json log_of(const msg::TaskEvent& event, std::uint64_t time_ns) {
  const bool trouble = event.goal_state == msg::kGoalAborted || event.goal_state == msg::kGoalRefused;
  std::string text =
      std::string(name_of(constants::kTask, event.task)) + ": " +
      (event.event == msg::kEventNone ? "goal " + std::string(name_of(constants::kGoal, event.goal_state))
                                      : name_of(constants::kEvent, event.event));
  if (event.colour != msg::kColourUnknown) text += " (" + std::string(name_of(constants::kColour, event.colour)) + ")";
  if (event.detail[0] != '\0') text += ": " + std::string(event.detail);
  return {{"timestamp", stamp(time_ns)},
          {"level", trouble ? 3 : 2},
          {"message", text},
          {"name", "navigation"},
          {"file", ""},
          {"line", 0}};
}

json log_of(const msg::LogLine& line) {
  // Foxglove's levels: 2 is an information, 3 a warning, 4 an error.
  const int level = line.level == msg::kLogError ? 4 : line.level == msg::kLogWarning ? 3 : 2;
  const std::string component = text_of(line.component);
  return {
      {"timestamp", stamp(static_cast<std::uint64_t>(std::max<std::int64_t>(line.wall_time_ns, 0)))},
      {"level", level},
      {"message", line.tick < 0 ? text_of(line.message) : fmt::format("tick {}: {}", line.tick, text_of(line.message))},
      {"name", component.empty() ? text_of(line.process) : component},
      {"file", ""},
      {"line", 0}};
}

}  // namespace constrictor::views
