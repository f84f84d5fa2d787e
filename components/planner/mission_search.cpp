// The moves of a search: which way the mission planner turns and drives to find the line, an object or a zone.
#include <cmath>
#include <cstdlib>

#include "planner/free_way.hpp"
#include "planner/mission_planner.hpp"
#include "robot/landmarks.hpp"
#include "robot/planar.hpp"

namespace constrictor {

// The head of a caught robot swings to and fro while it turns; the object in the U stays where it is.
bool MissionPlanner::stands_still(const PlannerInputs& inputs) {
  if (!inputs.pose) return false;
  double x_m = inputs.pose->x_m, y_m = inputs.pose->y_m;
  if (inputs.map) {
    if (const msg::MapObject* held = carried_object(*inputs.map)) {
      x_m = held->x_m;
      y_m = held->y_m;
    }
  }
  return memory_.standstill.notice(x_m, y_m, memory_.active_s, config_.standstill_m, config_.standstill_s);
}

std::uint8_t MissionPlanner::side_for(double turn_rad, const PlannerInputs& inputs) const {
  constexpr double kEitherWay_rad = 2.0;
  constexpr double kBeside_m = 1.5;
  double aside_m = 0.0;  // lateral position of the nearest zone, positive left
  double nearest_m = kBeside_m;
  if (!holding() && inputs.map && inputs.pose && std::abs(turn_rad) > kEitherWay_rad) {
    for (const msg::MapObject& landmark : landmarks_of(*inputs.map)) {
      const double dx_m = landmark.x_m - inputs.pose->x_m;
      const double dy_m = landmark.y_m - inputs.pose->y_m;
      const double distance_m = std::hypot(dx_m, dy_m);
      if (landmark.kind != msg::kBlobZone || distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      aside_m = -std::sin(inputs.pose->body_yaw_rad) * dx_m + std::cos(inputs.pose->body_yaw_rad) * dy_m;
    }
  }
  if (aside_m != 0.0) return aside_m > 0.0 ? msg::kDirectionRight : msg::kDirectionLeft;
  return turn_rad >= 0.0 ? msg::kDirectionLeft : msg::kDirectionRight;
}

Move MissionPlanner::move_for(double turn_rad, const PlannerInputs& inputs) const {
  constexpr double kAhead_rad = 0.25;
  constexpr double kBend_rad = 0.7;  // for larger angles, turning on the spot is faster
  const std::uint8_t side = side_for(turn_rad, inputs);
  // With an object the robot turns in a circle: a zone inside of it would stay beside the robot for ever.
  if (std::abs(turn_rad) > kBend_rad && holding() && remembered_m(inputs) < config_.turning_room_m &&
      ahead_free(inputs))
    return {msg::kTaskExplore, msg::kDirectionForwards};
  if (std::abs(turn_rad) > kBend_rad) return {msg::kTaskRotate, side};
  return {msg::kTaskExplore, std::abs(turn_rad) > kAhead_rad ? side : msg::kDirectionForwards};
}

bool MissionPlanner::ahead_free(const PlannerInputs& inputs) const {
  constexpr double kAhead_m = 1.0;
  if (!inputs.map || !inputs.pose) return true;
  const auto& pose = *inputs.pose;
  const Eigen::Vector2d head(pose.x_m, pose.y_m);
  const Eigen::Vector2d there = head + kAhead_m * along(pose.yaw_rad);
  return is_free_way(*inputs.map, head, there, config_.carry_room_m) &&
         is_free_of_objects(*inputs.map, head, there, config_.carry_room_m);
}

bool MissionPlanner::caught(const PlannerInputs& inputs) const {
  if (!inputs.map || !inputs.pose || (inputs.line && inputs.line->visible)) return false;
  const msg::MapObject* held = carried_object(*inputs.map);
  return held &&
         is_caught(*inputs.map, *held, {inputs.pose->x_m, inputs.pose->y_m}, config_.room_m, config_.carry_ahead_m);
}

bool MissionPlanner::zone_in_reach(const PlannerInputs& inputs) const {
  const msg::MapObject* zone = inputs.map ? zone_of(*inputs.map, colour()) : nullptr;
  const msg::MapObject* held = inputs.map ? carried_object(*inputs.map) : nullptr;
  return !zone || !held ||
         is_free_way(*inputs.map, {held->x_m, held->y_m}, {zone->x_m, zone->y_m}, config_.carry_room_m);
}

void MissionPlanner::lead_sweep(const PlannerInputs& inputs) {
  if (sweeps() && inputs.pose)
    memory_.sweep.lead(*inputs.pose, memory_.active_s, config_.sweep_m, scaled_s(config_.explore_s));
}

// Most moves use the memory: the robot turns towards the remembered place and moves there. The other moves, and all
// moves without a remembered place, alternate between turning left, turning right, forwards and backwards. The moves of
// a sweep all lead to its next corner.
void MissionPlanner::choose_search(const PlannerInputs& inputs, WantedTask& wanted) {
  constexpr std::uint8_t kMostBackward = 6;  // moves of a search; an object may slip out of a U that drives backwards
  const unsigned attempt = memory_.searches++;
  memory_.searched_s = memory_.active_s;
  lead_sweep(inputs);
  const auto turn_rad = wanted_turn_rad(inputs);
  memory_.search_by_memory = turn_rad.has_value() && (attempt % 16 < 12 || sweeps()) && !refusals().rejected();
  Move move{msg::kTaskExplore, attempt % 4 == 2 ? msg::kDirectionBackwards : msg::kDirectionForwards};
  if (memory_.search_by_memory) {
    move = move_for(*turn_rad, inputs);
  } else if (attempt % 2 == 1) {
    move = {msg::kTaskRotate, attempt % 4 == 1 ? msg::kDirectionLeft : msg::kDirectionRight};
  }
  if (holding()) {
    static_cast<void>(stands_still(inputs));
    if (const auto away = memory_.standstill.next()) {
      move = *away;
      memory_.search_by_memory = false;
    } else if (memory_.backed_off < kMostBackward && caught(inputs)) {
      ++memory_.backed_off;
      move = {msg::kTaskExplore, msg::kDirectionBackwards};
      memory_.search_by_memory = false;
    }
  }
  // After a refusal, the same move would be refused again.
  const bool again =
      refusals().rejected() && move.task == memory_.refusals.task &&
      (memory_.refusals.direction == msg::kDirectionNone || move.direction == memory_.refusals.direction);
  if (again || refusals().barred(move.task, memory_.active_s)) {
    move = move.task == msg::kTaskExplore ? Move{msg::kTaskRotate, side_for(1.0, inputs)}
                                          : Move{msg::kTaskExplore, msg::kDirectionForwards};
  }
  memory_.search_task = move.task;
  memory_.direction = move.direction;
  wanted.task = move.task;
  wanted.parameters.line_colour = config_.line_colour;
  wanted.parameters.direction = move.direction;
  if (move.task == msg::kTaskRotate) wanted.parameters.timeout_s = scaled_s(config_.rotate_s);
}

}  // namespace constrictor
