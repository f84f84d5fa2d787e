// What the mission planner does at the ends of the line, and with a line that it has found.
#include <cmath>

#include "planner/mission_planner.hpp"

namespace constrictor {

using enum MissionState;

// If zones lie where the mission began, an end of the line with zones nearby is the wrong end for a robot without an
// object. Once an object was found, the direction is known, and the end belongs to a short piece of line behind the
// robot.
std::optional<MissionState> MissionPlanner::end_of_line(const PlannerInputs& inputs) {
  if (memory_.state != kFollowLine && memory_.state != kTransport) return std::nullopt;
  const bool other_end = config_.sequence.empty() && memory_.state == kFollowLine && !leads_wanted_way(inputs);
  if (memory_.wrong_way || other_end) return recover(kTurnRound);
  if (config_.zones_at == kZonesAnywhere && !config_.sequence.empty()) return end_of_explored_line();
  const bool zones_about = memory_.active_s - memory_.zone_seen_s < config_.end_zone_s;
  if (zones_about && memory_.direction_known && memory_.state == kFollowLine) return recover(kSearchLineOrObject);
  memory_.line_ended_s = memory_.active_s;
  if (memory_.state == kTransport) return recover(kSearchLine);
  if (!zones_about) return config_.sequence.empty() ? kDone : kSearchObject;
  if (leads_wanted_way(inputs)) memory_.trail.reverse();
  return recover(kTurnRound);
}

MissionState MissionPlanner::end_of_explored_line() {
  memory_.trail.reverse();
  if (holding()) return recover(kTurnBack);
  memory_.line_ended_s = memory_.active_s;
  return kSearchObject;
}

void MissionPlanner::aim(const PlannerInputs& inputs) {
  if (config_.zones_at != kZonesAnywhere || !inputs.pose) return;
  const msg::MapObject* landmark = wanted_landmark(inputs);
  const auto direction_rad = memory_.trail.direction_rad(*inputs.pose, true);
  if (!landmark || !direction_rad) return;
  const double to_rad = std::atan2(landmark->y_m - inputs.pose->y_m, landmark->x_m - inputs.pose->x_m);
  if (std::cos(to_rad - *direction_rad) < 0.0) memory_.trail.reverse();
}

// The search turns a robot that sees the line towards the wanted direction. That may not succeed: beside the last piece
// of the line, the turning head sees only the line behind it. Then the robot turns round on the line itself.
std::optional<MissionState> MissionPlanner::follow_found_line(const PlannerInputs& inputs) {
  const bool right_way = may_follow(inputs);
  const bool tired = memory_.active_s - memory_.entered_s > config_.any_way_s && !leads_wanted_way(inputs);
  memory_.wrong_way = !right_way && tired;
  return right_way || tired ? std::optional(kFollowLine) : std::nullopt;
}

}  // namespace constrictor
