#include "views/newest.hpp"

#include "robot/planar_message.hpp"

namespace constrictor::views {

bool keep_world(Newest& newest, const msg::WorldState& world) {
  if (validate(world)) return false;
  const auto& before = newest.world;
  if (before && (before->header.run_id != world.header.run_id || before->header.epoch != world.header.epoch)) {
    newest.start.reset();
    newest.pose.reset();
    newest.map.reset();
    newest.line.reset();
    newest.blobs.reset();
    newest.heads.clear();
    newest.events.clear();
  }
  auto& events = newest.events;
  while (before && world.header.tick < before->header.tick && !events.empty() &&
         events.back().header.tick > world.header.tick)
    events.pop_back();
  if (before && world.header.tick < before->header.tick) newest.heads.clear();
  if (world.module_count > 0) newest.heads[world.header.tick] = world.module_poses[0];
  if (newest.heads.size() > Newest::kMostHeads) newest.heads.erase(newest.heads.begin());
  newest.world = world;
  return true;
}

bool keep_event(Newest& newest, const msg::TaskEvent& event) {
  if (validate(event)) return false;
  auto& events = newest.events;
  while (!events.empty() && events.back().header.sequence_number >= event.header.sequence_number)
    events.pop_back();  // a replay has gone back, or a new epoch has begun
  events.push_back(event);
  if (events.size() > Newest::kMostEvents) events.pop_front();
  return true;
}

void align(Newest& newest) {
  if (newest.start || !newest.world || !newest.pose || newest.world->module_count == 0) return;
  const std::int64_t apart = newest.world->header.tick - newest.pose->header.tick;
  if (apart < 0 || apart > 5) return;
  const PlanarPose head = planar(newest.world->module_poses[0]);
  const double yaw_rad = head.yaw_rad - newest.pose->yaw_rad;
  newest.start = PlanarPose{head.p - turned({newest.pose->x_m, newest.pose->y_m}, yaw_rad), yaw_rad};
}

}  // namespace constrictor::views
