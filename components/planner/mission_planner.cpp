#include "planner/mission_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace constrictor {
namespace {

using enum MissionState;

/// Angle wrapped into [-pi, pi].
double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

/// The planner's goals as the input layer numbers them: first source of level planner.
constexpr std::uint64_t kGoalBase = static_cast<std::uint64_t>(msg::kAuthorityPlanner) << 48;

const msg::Blob* nearest(const msg::ObjectPercepts& percepts, std::uint8_t colour, std::uint8_t kind) {
  const msg::Blob* best = nullptr;
  for (std::size_t i = 0; i < std::min<std::size_t>(percepts.blob_count, msg::kMaxBlobs); ++i) {
    const auto& blob = percepts.blobs[i];
    if (blob.colour != colour || blob.kind != kind || std::isnan(blob.range_m)) continue;
    if (!best || blob.range_m < best->range_m) best = &blob;
  }
  return best;
}

bool carries(MissionState state) { return state == kSearchLine || state == kTransport || state == kDrop; }

}  // namespace

const char* name_of(MissionState state) {
  switch (state) {
    case kSearchLineOrObject: return "search line or object";
    case kFollowLine: return "follow line";
    case kSearchObject: return "search object";
    case kTrackObject: return "track object";
    case kPregrasp: return "pregrasp";
    case kGrasp: return "grasp";
    case kSearchLine: return "search line";
    case kTransport: return "follow line to drop zone";
    case kDrop: return "drop";
    case kTurnRound: return "turn round";
    case kDone: return "done";
    case kFailed: return "failed";
  }
  return "unknown";
}

std::uint8_t MissionPlanner::colour() const {
  const std::size_t last = config_.sequence.size() - 1;
  return config_.sequence[std::min<std::size_t>(memory_.object_index, last)];
}

std::optional<WantedTask> MissionPlanner::step(const PlannerInputs& inputs) {
  if (memory_.state == kDone || memory_.state == kFailed) return std::nullopt;
  count_percepts(inputs);
  const MissionState to = next(inputs);
  if (to != memory_.state || !memory_.entered) enter(to, inputs.time_s);
  if (memory_.entered || to == kDone || to == kFailed) return std::nullopt;
  memory_.entered = true;
  return task_of_state(inputs);
}

void MissionPlanner::enter(MissionState state, double time_s) {
  memory_.state = state;
  memory_.entered = false;
  memory_.entered_s = time_s;
  memory_.object_seen = memory_.zone_seen = memory_.line_seen = 0;
}

void MissionPlanner::count_percepts(const PlannerInputs& inputs) {
  if (!inputs.fresh_percepts || !inputs.line || !inputs.objects) return;
  const auto count = [](std::uint16_t& counter, bool seen) { counter = seen ? static_cast<std::uint16_t>(std::min(counter + 1, 1000)) : std::uint16_t{0}; };
  const auto* object = nearest(*inputs.objects, colour(), msg::kBlobObject);
  const auto* zone = nearest(*inputs.objects, colour(), msg::kBlobZone);
  count(memory_.object_seen, object && object->range_m <= config_.object_range_m);
  count(memory_.zone_seen, zone && zone->range_m <= config_.zone_range_m);
  count(memory_.line_seen, inputs.line->visible && inputs.line->colour == config_.line_colour);
  // The heading along the line towards the objects, for the way back after a drop.
  if (memory_.state == kFollowLine && inputs.line->visible && inputs.pose) {
    memory_.has_outbound_yaw = true;
    memory_.outbound_yaw_rad = inputs.pose->yaw_rad;
  }
}

MissionState MissionPlanner::recover(MissionState to) {
  if (++memory_.recoveries > config_.max_recoveries) {
    memory_.reason = "more than " + std::to_string(config_.max_recoveries) + " recoveries";
    return kFailed;
  }
  return to;
}

MissionState MissionPlanner::next(const PlannerInputs& inputs) {
  if (!memory_.entered) return memory_.state;
  for (const auto* event : inputs.events) {
    if (event->goal_id != kGoalBase + memory_.goals) continue;  // of an earlier goal
    if (const auto to = next_by_event(*event)) return *to;
    if (const auto to = next_by_goal_end(*event)) return *to;
  }
  if (const auto to = next_by_percepts(inputs)) return *to;
  if (const auto to = next_by_time(inputs)) return *to;
  return memory_.state;
}

std::optional<MissionState> MissionPlanner::next_by_event(const msg::TaskEvent& event) {
  switch (event.event) {
    case msg::kEventLineLost:
      if (memory_.state == kFollowLine) return recover(kSearchLineOrObject);
      if (memory_.state == kTransport) return recover(kSearchLine);
      return std::nullopt;
    case msg::kEventEndOfLine:
      if (memory_.state == kFollowLine) return kSearchObject;
      if (memory_.state == kTransport) return kSearchLine;  // the zone is not in view: look around
      return std::nullopt;
    case msg::kEventObjectFound:
      return memory_.state == kSearchObject ? std::optional(kTrackObject) : std::nullopt;
    case msg::kEventObjectReached:
      return memory_.state == kTrackObject ? std::optional(kPregrasp) : std::nullopt;
    case msg::kEventObjectLost:
      return memory_.state == kTrackObject ? std::optional(recover(kSearchObject)) : std::nullopt;
    case msg::kEventObjectPregrasped:
      return memory_.state == kPregrasp ? std::optional(kGrasp) : std::nullopt;
    case msg::kEventObjectPregraspLost:
      return memory_.state == kPregrasp || memory_.state == kGrasp ? std::optional(recover(kSearchObject)) : std::nullopt;
    case msg::kEventObjectGrasped:
      return memory_.state == kGrasp ? std::optional(kSearchLine) : std::nullopt;
    case msg::kEventObjectGraspLost:
      return memory_.state == kGrasp || carries(memory_.state) ? std::optional(recover(kSearchObject)) : std::nullopt;
    case msg::kEventDroppingDone:
      if (memory_.state != kDrop) return std::nullopt;
      ++memory_.object_index;
      return memory_.object_index == config_.sequence.size() ? kDone : kTurnRound;
    case msg::kEventTimeout:
      return memory_.state == kTurnRound ? std::optional(kSearchLineOrObject) : std::nullopt;
    default: return std::nullopt;
  }
}

std::optional<MissionState> MissionPlanner::next_by_goal_end(const msg::TaskEvent& event) {
  const bool failed = event.goal_state == msg::kGoalAborted || event.goal_state == msg::kGoalRefused;
  const bool ended = failed || event.goal_state == msg::kGoalSucceeded || event.goal_state == msg::kGoalCancelled;
  if (!ended) return std::nullopt;
  switch (memory_.state) {
    case kSearchLineOrObject:
    case kSearchLine:
      memory_.entered = false;  // the same search again, differently
      return memory_.state;
    case kTurnRound: return kSearchLineOrObject;
    case kFollowLine: return failed ? recover(kSearchLineOrObject) : kSearchObject;
    case kTransport: return recover(kSearchLine);
    case kDrop: return recover(failed ? kSearchObject : kSearchLine);
    case kGrasp:
    case kPregrasp:
    case kTrackObject: return recover(kSearchObject);
    case kSearchObject: return recover(kSearchLineOrObject);
    default: return std::nullopt;
  }
}

std::optional<MissionState> MissionPlanner::next_by_percepts(const PlannerInputs& inputs) {
  const bool object = memory_.object_seen >= config_.confirm_images;
  const bool line = memory_.line_seen >= config_.confirm_images;
  const bool zone = memory_.zone_seen >= config_.confirm_images;
  switch (memory_.state) {
    case kSearchLineOrObject:
      if (object) return kTrackObject;
      if (line) return kFollowLine;
      return std::nullopt;
    case kFollowLine: return object ? std::optional(kTrackObject) : std::nullopt;
    case kSearchLine:
      if (zone) return kDrop;
      return line ? std::optional(kTransport) : std::nullopt;
    case kTransport: return zone ? std::optional(kDrop) : std::nullopt;
    case kTurnRound: {
      const bool turned = !memory_.has_outbound_yaw ||
                          (inputs.pose && std::abs(wrapped(inputs.pose->yaw_rad - memory_.outbound_yaw_rad)) < config_.turned_rad);
      return line && turned ? std::optional(kFollowLine) : std::nullopt;
    }
    default: return std::nullopt;
  }
}

std::optional<MissionState> MissionPlanner::next_by_time(const PlannerInputs& inputs) {
  if (inputs.time_s > config_.mission_timeout_s) {
    memory_.reason = "mission time is over in state " + std::string(name_of(memory_.state));
    return kFailed;
  }
  const double in_state_s = inputs.time_s - memory_.entered_s;
  switch (memory_.state) {
    case kSearchLineOrObject:
    case kSearchLine:
      // Exploring and turning alternate; task_of_state chooses by the count of searches.
      if (in_state_s > (memory_.searches % 2 == 1 ? config_.explore_s : config_.rotate_s + 1.0)) memory_.entered = false;
      return std::nullopt;
    case kFollowLine: return in_state_s > config_.follow_timeout_s ? std::optional(recover(kSearchLineOrObject)) : std::nullopt;
    case kTransport: return in_state_s > config_.follow_timeout_s ? std::optional(recover(kSearchLine)) : std::nullopt;
    case kTurnRound: return in_state_s > config_.turn_round_s + 1.0 ? std::optional(kSearchLineOrObject) : std::nullopt;
    case kSearchObject: return in_state_s > config_.task_timeout_s ? std::optional(recover(kSearchLineOrObject)) : std::nullopt;
    default: return in_state_s > config_.task_timeout_s ? std::optional(recover(kSearchObject)) : std::nullopt;
  }
}

WantedTask MissionPlanner::task_of_state(const PlannerInputs& inputs) {
  WantedTask wanted;
  wanted.goal_id = ++memory_.goals;
  auto& parameters = wanted.parameters;
  parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  switch (memory_.state) {
    case kFollowLine:
    case kTransport:
      wanted.task = msg::kTaskFollowLine;
      parameters.line_colour = config_.line_colour;
      break;
    case kSearchObject:
    case kTrackObject:
    case kPregrasp:
    case kGrasp:
      wanted.task = memory_.state == kSearchObject  ? msg::kTaskSearchObject
                    : memory_.state == kTrackObject ? msg::kTaskTrackObject
                    : memory_.state == kPregrasp    ? msg::kTaskPregrasp
                                                    : msg::kTaskGrasp;
      parameters.object_colour = colour();
      break;
    case kDrop:
      wanted.task = msg::kTaskDrop;
      parameters.drop_zone_colour = colour();
      break;
    case kTurnRound: {
      wanted.task = msg::kTaskRotate;
      const double to_turn = inputs.pose ? wrapped(memory_.outbound_yaw_rad - inputs.pose->yaw_rad) : 1.0;
      parameters.direction = to_turn >= 0.0 ? msg::kDirectionLeft : msg::kDirectionRight;
      parameters.timeout_s = config_.turn_round_s;
      break;
    }
    default:  // the two searches for the line: explore, then turn, left and right in turn
      ++memory_.searches;
      if (memory_.searches % 2 == 1) {
        wanted.task = msg::kTaskExplore;
        parameters.direction = memory_.searches % 8 == 5 ? msg::kDirectionBackwards : msg::kDirectionForwards;
      } else {
        wanted.task = msg::kTaskRotate;
        parameters.direction = memory_.searches % 4 == 2 ? msg::kDirectionLeft : msg::kDirectionRight;
        parameters.timeout_s = config_.rotate_s;
      }
      parameters.line_colour = config_.line_colour;
      break;
  }
  return wanted;
}

}  // namespace constrictor
