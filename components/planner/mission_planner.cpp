#include "planner/mission_planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "constrictor/constants.hpp"
#include "constrictor/text.hpp"

namespace constrictor {
namespace {

using enum MissionState;

/// Goal ids of the built-in planner on task/command: `input` adds this to the planner's own numbers.
constexpr std::uint64_t kGoalBase = static_cast<std::uint64_t>(msg::kAuthorityPlanner) << 48;

bool turns(MissionState state) { return state == kTurnRound || state == kTurnBack; }

}  // namespace

std::uint8_t MissionPlanner::colour() const {
  if (config_.sequence.empty()) return msg::kColourUnknown;
  const std::size_t last = config_.sequence.size() - 1;
  return config_.sequence[std::min<std::size_t>(memory_.object_index, last)];
}

std::optional<WantedTask> MissionPlanner::step(const PlannerInputs& inputs) {
  if (memory_.state == kDone || memory_.state == kFailed) return std::nullopt;
  const double elapsed_s = std::max(0.0, inputs.time_s - memory_.last_s);
  memory_.last_s = inputs.time_s;
  if (inputs.map && inputs.status && inputs.status->carrying) memory_.newest_carried = newest_handle(*inputs.map);
  note_drops(inputs);
  memory_.unseen_s = inputs.new_percepts ? 0.0 : memory_.unseen_s + elapsed_s;
  const bool mine = may_command(inputs, elapsed_s);
  // Time under the authority of others does not count: the robot may have looked away or stood still.
  if (!mine) memory_.unseen_s = 0.0;
  const bool waits = mine && waits_for_percepts(inputs);
  memory_.hindrance = hindrance(inputs);
  if (waits && std::exchange(memory_.requested, false)) return cancellation();
  if (!mine || waits) return std::nullopt;
  if (memory_.state == kDone || memory_.state == kFailed) return std::nullopt;
  memory_.active_s += elapsed_s;
  // Navigation's report about a held object and the state change at different ticks, so a short contradiction is
  // normal.
  const bool contradicts = inputs.status && memory_.requested && inputs.status->goal_id == kGoalBase + memory_.goals &&
                           inputs.status->carrying != holding();
  memory_.contradiction_s = contradicts ? memory_.contradiction_s + elapsed_s : 0.0;
  if (memory_.state == kDrop) {
    memory_.released_tick = inputs.tick;  // the body may push the object until it has left it
    memory_.newest_handle = memory_.newest_carried;
  }
  if (inputs.status && memory_.state == kPregrasp && inputs.status->goal_id == kGoalBase + memory_.goals &&
      inputs.status->parameters.direction != msg::kDirectionNone)
    attempts().side = inputs.status->parameters.direction;
  count_percepts(inputs);
  watch_placed_objects(inputs, elapsed_s);
  if (memory_.requested || refusals().any()) {
    if (const auto to = next(inputs)) {
      const bool aims = *to != memory_.state && (memory_.state == kGrasp || *to == kTurnRound);
      enter(*to);
      if (aims) aim(inputs);
    }
  }
  if (const std::string reason = refusals().give_up(memory_.active_s); !reason.empty()) enter(fail(reason));
  memory_.hindrance = hindrance(inputs);
  const bool over = memory_.state == kDone || memory_.state == kFailed;
  if (over && memory_.goals > 0) return cancellation();  // the final state would not end the running task
  if (memory_.requested || over) return std::nullopt;
  if (refusals().pausing(memory_.active_s) || barred(memory_.state)) {
    memory_.entered_s += elapsed_s;  // the pause is not part of the state's time
    return std::nullopt;
  }
  if (waits_for_percepts(inputs)) return std::nullopt;  // the state that has begun needs them
  memory_.requested = true;
  memory_.requested_s = memory_.active_s;
  return task_of_state(inputs);
}

WantedTask MissionPlanner::cancellation() const {
  WantedTask cancel;
  cancel.goal_id = memory_.goals;
  cancel.command = msg::kCommandCancel;
  return cancel;
}

void MissionPlanner::enter(MissionState state) {
  if (state != memory_.state) {
    // A caught robot may lose the line and find it again in turn. The time for which it stands still goes on then.
    constexpr double kAnew_s = 10.0;
    const bool loses_line = memory_.state == kTransport && state == kSearchLine;
    const bool finds_line = memory_.state == kSearchLine && state == kTransport;
    if (!loses_line && !(finds_line && memory_.active_s - memory_.entered_s <= kAnew_s)) memory_.standstill.begin();
    memory_.entered_s = memory_.active_s;
    memory_.object_images = memory_.zone_images = memory_.line_images = 0;
    memory_.vain_looks = memory_.step_backs = 0;
    // A new search begins with what it remembers. The count goes on while a search alternates with the following of a
    // line that is lost again at once.
    if (memory_.active_s - memory_.searched_s > kAnew_s) {
      memory_.searches = memory_.backed_off = 0;
      if (!leaves_line()) memory_.sweep.end();  // otherwise it would begin anew whenever a line has led the robot away
    }
  }
  if (memory_.state == kTurnBack && state == kSearchLine) {
    memory_.turned_back_s = memory_.active_s;
    memory_.vain_turns = static_cast<std::uint8_t>(std::min(memory_.vain_turns + 1, 100));
  }
  if (state != kFollowLine) memory_.wrong_way = false;
  if (state == kGrasp) {
    memory_.direction_known = true;
    memory_.line_ended_s = -1e9;  // the head comes back round the object; that end of the line is behind it then
  }
  if (row_of(state).holding) {
    memory_.dropped = false;
    memory_.released_tick = -1;
  } else {
    memory_.standstill.end();
    memory_.vain_turns = 0;
  }
  if (state != kPregrasp && state != kGrasp) memory_.object_handle = 0;
  memory_.state = state;
  memory_.requested = memory_.steps_back = false;
  memory_.contradiction_s = 0.0;
}

bool MissionPlanner::may_command(const PlannerInputs& inputs, double elapsed_s) {
  if (!inputs.authority) return true;
  const std::uint8_t level = inputs.authority->level;
  const bool others = level == msg::kAuthorityExternal || level == msg::kAuthorityOperator;
  if (inputs.authority->emergency_stop) {
    memory_.stopped = true;
  } else if (others) {
    memory_.stopped = false;  // the holder of authority will release it to the planner
  }
  if (memory_.stopped || others) {
    memory_.suspended_s = memory_.suspended ? memory_.suspended_s + elapsed_s : 0.0;
    memory_.suspended = true;
    if (memory_.suspended_s > config_.suspended_timeout_s)
      enter(fail("suspended for " + std::to_string(std::lround(memory_.suspended_s)) + " s: it " + hindrance(inputs)));
    return false;
  }
  if (memory_.suspended) resume(inputs);
  return true;
}

// The robot may be anywhere after a suspension: the mission continues with a look at what was dropped, or a search.
void MissionPlanner::resume(const PlannerInputs& inputs) {
  memory_.suspended = false;
  refusals().forget();
  const bool carrying = inputs.status ? inputs.status->carrying : holding();
  const bool looks = !carrying && (memory_.dropped || inspect_unseen());
  // If no other object is left, the robot may carry one of those that it has not looked at yet.
  if (!looks && !config_.sequence.empty() && !choose_object() && !inspect_unseen()) {
    enter(end_of_sequence());
    return;
  }
  if (carrying) {
    enter(kSearchLine);
  } else if (memory_.dropped) {
    enter(kInspect);
  } else if (!turns(memory_.state)) {
    enter(kSearchLineOrObject);
  } else {
    enter(kTurnRound);
  }
  memory_.requested = false;
}

bool MissionPlanner::waits_for_percepts(const PlannerInputs& inputs) {
  if (memory_.blind && inputs.new_percepts) {
    memory_.blind = false;
    resume(inputs);
  }
  // Grasp and drop need no images, and their cancellation would lose the object.
  const bool by_touch = memory_.state == kGrasp || memory_.state == kDrop;
  if (!by_touch && memory_.unseen_s > config_.blind_pause_s) memory_.blind = true;
  if (memory_.blind && memory_.unseen_s > config_.blind_timeout_s)
    enter(fail("no percepts for " + std::to_string(std::lround(memory_.unseen_s)) +
               " s: are the camera and perception running?"));
  return memory_.blind;
}

MissionState MissionPlanner::fail(const std::string& reason) {
  memory_.reason = reason;
  return kFailed;
}

Attempts& MissionPlanner::attempts(std::size_t object) {
  if (memory_.attempts.size() <= object) memory_.attempts.resize(object + 1);
  return memory_.attempts[object];
}

MissionState MissionPlanner::recover(MissionState to, const std::string& why) {
  if (memory_.recoveries >= config_.max_recoveries) {
    return fail("more than " + std::to_string(config_.max_recoveries) + " recoveries, the last in state " +
                name_of(memory_.state) + (why.empty() ? "" : ": " + why));
  }
  ++memory_.recoveries;
  // From the same place, a drop that has failed would be repeated on the same course.
  if (memory_.state == kDrop && to == kSearchLine) memory_.standstill.lead_away();
  if (memory_.state == kSearchObject) return to == kSearchLineOrObject ? search_elsewhere(why) : to;
  return to == kSearchObject ? try_differently(why) : to;
}

std::optional<MissionState> MissionPlanner::next(const PlannerInputs& inputs) {
  for (const auto* event : inputs.events) {
    const bool own = memory_.requested && event->goal_id == kGoalBase + memory_.goals;
    // The loss of an object may belong to the previous goal, if navigation sent the event before it received a new
    // request.
    const bool loss = holding() && event->event == msg::kEventObjectGraspLost && event->goal_id > kGoalBase &&
                      event->goal_id <= kGoalBase + memory_.goals;
    if (!own && !loss) continue;
    if (own && event->goal_state == msg::kGoalRefused) return refused(text_of(event->detail), inputs);
    if (own) refusals().accept(requested_task());
    if (const auto to = next_by_event(*event, inputs)) return to;
    if (!own) continue;
    if (const auto to = next_by_goal_state(event->goal_state, text_of(event->detail), inputs)) return to;
  }
  if (const auto to = next_by_status(inputs)) return to;
  if (const auto to = next_by_percepts(inputs); to && !barred(*to)) return to;
  return next_by_time(inputs);
}

std::optional<MissionState> MissionPlanner::next_by_event(const msg::TaskEvent& event, const PlannerInputs& inputs) {
  if (event.event == msg::kEventEndOfLine) return end_of_line(inputs);
  // Of two objects of one colour, the nearer one may be reached although the other one was meant.
  const msg::MapObject* reached = event.event == msg::kEventObjectReached && inputs.map
                                      ? object_of_handle(*inputs.map, event.object_handle)
                                      : nullptr;
  if (reached && has_delivered_twin() && is_placed(*reached, inputs))
    return recover(kSearchObject, "a delivered object of its colour was reached instead");
  if (event.event == msg::kEventObjectReached || event.event == msg::kEventObjectPregrasped)
    memory_.object_handle = event.object_handle;
  for (const auto& loss : row_of(memory_.state).losses) {
    if (loss.event == msg::kEventNone || loss.event != event.event) continue;
    const std::string detail = text_of(event.detail);
    return recover(loss.to, detail.empty() ? words_of(constants::kEvent, event.event) : detail);
  }
  return std::nullopt;
}

std::optional<MissionState> MissionPlanner::next_by_goal_state(std::uint8_t goal_state, const std::string& reason,
                                                               const PlannerInputs& inputs) {
  const StateRow& row = row_of(memory_.state);
  const bool failed = goal_state == msg::kGoalAborted || goal_state == msg::kGoalCancelled;
  if (goal_state != msg::kGoalSucceeded && !failed) return std::nullopt;
  if (memory_.state == kInspect) return after_inspection(!failed, inputs);
  // At real-time pace the status may arrive before the event that says the same.
  if (!failed && (memory_.state == kFollowLine || memory_.state == kTransport)) return end_of_line(inputs);
  if (!failed) return memory_.state == kDrop ? after_drop(inputs) : row.succeeded;
  if (turns(memory_.state) || memory_.state == kApproachAnew) return row.failed;
  return recover(row.failed, reason.empty() ? "the task was given up" : reason);
}

std::optional<MissionState> MissionPlanner::next_by_status(const PlannerInputs& inputs) {
  if (!inputs.status || !memory_.requested) return std::nullopt;
  const auto& status = *inputs.status;
  if (status.goal_id != kGoalBase + memory_.goals) return next_without_answer(inputs);
  if (status.goal_state == msg::kGoalRefused) return refused(text_of(status.reason), inputs);
  refusals().accept(requested_task());
  if (const auto to = next_by_goal_state(status.goal_state, text_of(status.reason), inputs)) return to;
  // During grasp and drop, `carrying` changes within the state.
  if (memory_.contradiction_s < kMissionPatience_s || memory_.state == kGrasp || memory_.state == kDrop)
    return std::nullopt;
  return recover(status.carrying ? kSearchLine : kSearchObject, "navigation holds no object");
}

std::optional<MissionState> MissionPlanner::next_by_percepts(const PlannerInputs& inputs) {
  const bool object = memory_.object_images >= config_.confirm_images;
  const bool zone = zone_found(inputs);
  // Just after the end of the line, only the end piece of the same line can be in view.
  const bool line = memory_.line_images >= config_.confirm_images &&
                    memory_.active_s - memory_.line_ended_s > scaled_s(config_.after_end_s);
  switch (memory_.state) {
    case kSearchLineOrObject:
      if (object) return kTrackObject;
      return line ? follow_found_line(inputs) : std::nullopt;
    case kFollowLine:
      if (object) return kTrackObject;
      return memory_.wrong_way && memory_.active_s - memory_.entered_s > config_.wrong_way_s
                 ? std::optional(recover(kTurnRound))
                 : std::nullopt;
    case kInspect: {
      if (memory_.released_tick < 0) return std::nullopt;
      const MissionState to = after_drop(inputs);
      return to == kInspect ? std::nullopt : std::optional(to);
    }
    case kSearchObject:
    case kTrackObject:
      // A dropped object that no image had shown before may stand on its zone after all.
      return memory_.released_tick >= 0 && dropped_object(inputs).verdict == Delivery::kOnZone
                 ? std::optional(delivered(inputs))
                 : std::nullopt;
    case kSearchLine:
      if (memory_.standstill.leads_away()) return std::nullopt;
      if (zone) return kDrop;
      if (!line) return std::nullopt;
      if (leads_wanted_way(inputs)) return kTransport;
      // Turning back helps only where the line leads to the zone. It is not repeated where it has just failed, nor
      // with an object with which it has failed twice.
      if (leaves_line() || remembered_m(inputs) < config_.remembered_range_m ||
          memory_.active_s - memory_.turned_back_s < scaled_s(config_.any_way_s))
        return std::nullopt;
      return recover(kTurnBack);
    case kTransport:
      return zone && zone_in_reach(inputs) ? std::optional(kDrop) : std::nullopt;
    case kTurnRound:
    case kTurnBack: {
      if (zone && holding()) return kDrop;
      if (line && may_follow(inputs)) return holding() ? kTransport : kFollowLine;
      return has_turned(inputs) ? std::optional(row_of(memory_.state).succeeded) : std::nullopt;
    }
    default:
      return std::nullopt;
  }
}

std::optional<MissionState> MissionPlanner::next_by_time(const PlannerInputs& inputs) {
  if (memory_.active_s > config_.mission_timeout_s) {
    const std::string left = not_delivered();
    return fail("the time limit of the mission passed in state " + std::string(name_of(memory_.state)) +
                (left.empty() ? "" : "; it has not delivered " + left));
  }
  if (!memory_.requested) return std::nullopt;  // it pauses after a refusal
  const double in_state_s = memory_.active_s - memory_.entered_s;
  if (searches()) {
    if (in_state_s > scaled_s(config_.search_timeout_s)) {
      memory_.entered_s = memory_.active_s;
      return recover(memory_.state);
    }
    if (holding() && stands_still(inputs)) return memory_.state;  // the next move leads away
    lead_sweep(inputs);
    const bool exploring = memory_.search_task == msg::kTaskExplore;
    const double requested_for_s = memory_.active_s - memory_.requested_s;
    const double move_s = exploring ? config_.explore_s : config_.rotate_s;
    // A move that leads away from where the memory points is short.
    const bool short_move =
        memory_.standstill.leading() || (!memory_.search_by_memory && wanted_turn_rad(inputs).has_value());
    if (requested_for_s > (short_move ? move_s : scaled_s(move_s))) return memory_.state;
    if (!memory_.search_by_memory) return std::nullopt;
    if (!exploring) return has_turned(inputs) ? std::optional(memory_.state) : std::nullopt;
    const auto turn_rad = wanted_turn_rad(inputs);
    const bool astray = turn_rad && requested_for_s > kMissionPatience_s && std::abs(*turn_rad) > config_.aligned_rad;
    return astray ? std::optional(memory_.state) : std::nullopt;
  }
  const StateRow& row = row_of(memory_.state);
  const bool nears_zone = memory_.state == kDrop && inputs.status && inputs.status->carrying;
  if ((memory_.state == kTransport || nears_zone) && stands_still(inputs)) return recover(row.failed);
  if (memory_.state == kInspect) {
    if (in_state_s > config_.inspect_s) return after_inspection(false, inputs);
    const bool away = memory_.steps_back && memory_.active_s - memory_.requested_s > config_.step_back_s;
    return away ? std::optional(kInspect) : std::nullopt;
  }
  if (memory_.state == kApproachAnew)
    return in_state_s > config_.approach_anew_s ? std::optional(row.failed) : std::nullopt;
  if (turns(memory_.state)) return in_state_s > longest_turn_s() ? std::optional(row.failed) : std::nullopt;
  const bool follows = memory_.state == kFollowLine || memory_.state == kTransport;
  const bool finds = memory_.state == kSearchObject;
  const bool at_end = finds && config_.zones_at == kZonesAnywhere;
  const double limit_s = follows  ? scaled_s(config_.follow_timeout_s)
                         : at_end ? std::min(config_.end_search_s, config_.find_timeout_s)
                         : finds  ? config_.find_timeout_s
                                  : config_.task_timeout_s;
  if (in_state_s <= limit_s) return std::nullopt;
  return recover(row.failed, finds ? fmt::format("not found within {:g} s", limit_s) : "its time limit passed");
}

}  // namespace constrictor
