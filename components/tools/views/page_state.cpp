// The state that the page shows.
#include <cmath>

#include "constrictor/constants.hpp"
#include "robot/planar_message.hpp"
#include "views/views.hpp"

namespace constrictor::views {
namespace {

using nlohmann::json;

/// To 0.01 mm, 0.01 mN and the like: shorter texts, which browsers read faster. JSON has no NaN.
json number(double value) { return std::isfinite(value) ? json(std::round(value * 1e5) / 1e5) : json(); }

json line_of(std::size_t count, const double* x_m, const double* y_m) {
  json points = json::array();
  for (std::size_t i = 0; i < count; ++i) points.push_back({number(x_m[i]), number(y_m[i])});
  return points;
}

/// [x, y, yaw, z, qx, qy, qz, qw] in W: the first three for the scene from above.
json pose_of(const msg::Pose3& pose) {
  const PlanarPose flat = planar(pose);
  const auto& q = pose.orientation;
  return {number(flat.p.x()), number(flat.p.y()), number(flat.yaw_rad), number(pose.position_m.z),
          number(q.x),        number(q.y),        number(q.z),          number(q.w)};
}

json size_of(const msg::Vector3& size) { return {number(size.x), number(size.y), number(size.z)}; }

json scene_of(const msg::SceneDescription& scene) {
  json zones = json::array();
  for (std::size_t i = 0; i < scene.zone_count; ++i) {
    const auto& zone = scene.zones[i];
    zones.push_back({{"colour", name_of(constants::kColour, zone.colour)},
                     {"x_m", zone.x_m},
                     {"y_m", zone.y_m},
                     {"radius_m", zone.radius_m}});
  }
  json obstacles = json::array();
  for (std::size_t i = 0; i < scene.obstacle_count; ++i) {
    const auto& obstacle = scene.obstacles[i];
    obstacles.push_back({{"pose", pose_of(obstacle.pose)},
                         {"size_m", size_of(obstacle.size_m)},
                         {"box", obstacle.shape == msg::kShapeBox}});
  }
  return {{"epoch", scene.header.epoch},
          {"scenario", scene.scenario},
          {"seed", scene.seed},
          {"module_length_m", scene.module_length_m},
          {"module_radius_m", scene.module_radius_m},
          {"line", line_of(scene.line_point_count, scene.line_x_m, scene.line_y_m)},
          {"line_colour", name_of(constants::kColour, scene.line_colour)},
          {"line_width_m", scene.line_width_m},
          {"zones", zones},
          {"obstacles", obstacles}};
}

json world_of(const Newest& newest) {
  const msg::WorldState& world = *newest.world;
  json modules = json::array();
  for (std::size_t i = 0; i < world.module_count; ++i) modules.push_back(pose_of(world.module_poses[i]));
  json objects = json::array();
  for (std::size_t i = 0; newest.scene && i < std::min(world.object_count, newest.scene->object_count); ++i) {
    const auto& object = newest.scene->objects[i];
    objects.push_back({{"colour", name_of(constants::kColour, object.colour)},
                       {"pose", pose_of(world.object_poses[i])},
                       {"size_m", size_of(object.size_m)},
                       {"box", object.shape == msg::kShapeBox}});
  }
  return {{"time_s", static_cast<double>(world.header.time_ns) * 1e-9},
          {"tick", world.header.tick},
          {"modules", modules},
          {"objects", objects}};
}

json map_of(const Newest& newest) {
  json objects = json::array();
  for (std::size_t i = 0; i < newest.map->object_count; ++i) {
    const auto& object = newest.map->objects[i];
    objects.push_back({{"handle", object.handle},
                       {"colour", name_of(constants::kColour, object.colour)},
                       {"zone", object.kind == msg::kBlobZone},
                       {"x_m", number(object.x_m)},
                       {"y_m", number(object.y_m)},
                       {"radius_m", number(object.radius_m)},
                       {"height_m", number(object.height_m)},
                       {"sd_m", number(object.sd_m)},
                       {"carried", object.carried}});
  }
  return {{"tick", newest.map->header.tick},
          {"line", line_of(newest.map->line_point_count, newest.map->line_x_m, newest.map->line_y_m)},
          {"obstacles", line_of(newest.map->obstacle_count, newest.map->obstacle_x_m, newest.map->obstacle_y_m)},
          {"objects", objects}};
}

json processes_of(const Newest& newest) {
  json list = json::array();
  for (const auto& [component, status] : newest.processes) {
    list.push_back({{"component", component},
                    {"state", name_of(constants::kComponent, status.state)},
                    {"host", status.host},
                    {"pid", status.pid},
                    {"incarnation", status.incarnation},
                    {"tick", status.tick},
                    {"step_p99_us", number(status.step_time_p99_us)},
                    {"refused", status.refused_count},
                    {"last_refusal", status.last_refusal}});
  }
  return list;
}

}  // namespace

json page_state(const Newest& newest) {
  json state = {{"processes", processes_of(newest)}, {"events", json::array()}};
  if (newest.scene) state["scene"] = scene_of(*newest.scene);
  if (newest.world) state["world"] = world_of(newest);
  if (newest.joints) {
    json torques = json::array();
    for (std::size_t i = 0; i < newest.joints->joint_count; ++i) torques.push_back(number(newest.joints->torque_nm[i]));
    state["torque_nm"] = torques;
  }
  if (newest.contacts) {
    json contacts = json::array();  // [x, y, z, fx, fy, fz] in W, [m] and [N]
    for (const auto& [p, f] : contact_arrows(newest))
      contacts.push_back({number(p.x()), number(p.y()), number(p.z()), number(f.x()), number(f.y()), number(f.z())});
    state["contacts"] = contacts;
  }
  if (newest.start) state["start"] = {newest.start->p.x(), newest.start->p.y(), newest.start->yaw_rad};
  if (newest.pose) state["pose"] = {number(newest.pose->x_m), number(newest.pose->y_m), number(newest.pose->yaw_rad)};
  if (newest.map) state["map"] = map_of(newest);
  if (newest.mission) {
    const auto& mission = *newest.mission;
    state["mission"] = {{"outcome", name_of(constants::kMission, mission.outcome)},
                        {"state", mission.state},
                        {"object", mission.object_index},
                        {"objects", mission.object_count},
                        {"delivered", mission.delivered_count},
                        {"colour", name_of(constants::kColour, mission.colour)},
                        {"recoveries", mission.recoveries},
                        {"reason", mission.reason}};
  }
  if (newest.task) {
    const auto& task = *newest.task;
    state["task"] = {{"task", name_of(constants::kTask, task.task)},
                     {"goal", name_of(constants::kGoal, task.goal_state)},
                     {"phase", task.phase},
                     {"progress", number(task.progress)},
                     {"reason", task.reason}};
  }
  if (newest.authority) {
    state["authority"] = {{"level", name_of(constants::kAuthority, newest.authority->level)},
                          {"source", newest.authority->source}};
  }
  if (newest.stop) state["stopped"] = newest.stop->stopped;
  if (newest.run) {
    const auto& run = *newest.run;
    state["run"] = {{"tick", run.tick}, {"paused", run.paused},
                    {"seed", run.seed}, {"realtime", run.realtime},
                    {"pace", run.pace}, {"real_time_factor", number(run.real_time_factor)}};
  }
  if (newest.replay) state["replay"] = *newest.replay;
  for (const auto& event : newest.events) {
    json line = log_of(event, 0);
    state["events"].push_back({{"time_s", static_cast<double>(event.header.time_ns) * 1e-9},
                               {"trouble", line["level"] == 3},
                               {"text", line["message"]}});
  }
  return state;
}

}  // namespace constrictor::views
