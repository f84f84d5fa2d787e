// The mission: the objects in their order, each tracked, grasped, carried and dropped; and what holds for all requests.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "component/task_parameters.hpp"
#include "configuration/counted.hpp"
#include "conform/part_restart.hpp"
#include "conform/planner_conformance.hpp"

namespace constrictor::conform {
namespace {

constexpr double kObject_m = 1.0, kZone_m = 0.8;
constexpr std::uint16_t kHandle = 7;

}  // namespace

bool PlannerConformance::brings_object_to(std::size_t index) {
  hand_->see_line(true);
  hand_->see_no_objects();
  const msg::Request* now = hand_->newest();
  if ((now == nullptr || now->task != msg::kTaskFollowLine) && !starts({msg::kTaskFollowLine}, profile_.turn_s))
    return false;
  hand_->run(profile_.way_s);
  hand_->see(mission_.sequence[index], msg::kBlobObject, kObject_m);
  return starts({msg::kTaskTrackObject}, profile_.decide_s) &&
         hand_->newest()->parameters.object_colour == mission_.sequence[index];
}

bool PlannerConformance::check_object() {
  if (mission_.sequence.empty()) return false;
  const std::uint8_t colour = mission_.sequence.front();
  // On the way, an object that the mission does not name next.
  hand_->see_line(true);
  const msg::Request* now = hand_->newest();
  if (now->task != msg::kTaskFollowLine && !starts({msg::kTaskFollowLine}, profile_.turn_s)) {
    report_.fail("other_object", newest() + ": the line is not followed any more",
                 "request follow_line when some images show the line, after each interruption");
    return false;
  }
  const std::uint8_t other = colour == msg::kColourYellow ? msg::kColourRed : msg::kColourYellow;
  hand_->see(other, msg::kBlobObject, kObject_m);
  const bool deceived = starts({msg::kTaskTrackObject, msg::kTaskPregrasp, msg::kTaskGrasp}, profile_.decide_s);
  report_.judge("other_object", deceived,
                deceived ? newest() : fmt::format("a {} object is left alone", colour_name(other)),
                "compare the colour of the blob with that of the next object of the mission");
  const bool found = brings_object_to(0);
  report_.judge("object", !found, newest(),
                "request track_object after several images have shown the object, 1 m away");
  if (!found) return false;

  hand_->run(1.0);
  hand_->report(msg::kEventObjectReached, msg::kGoalSucceeded, kHandle, 5);
  const bool wrong = starts({msg::kTaskPregrasp, msg::kTaskGrasp}, 1.0);
  report_.judge("wrong_goal", wrong, wrong ? newest() + " after an event of another goal" : "nothing follows",
                "compare TaskEvent.goal_id with the goal that runs");
  if (!wrong) {
    hand_->report(msg::kEventObjectReached, msg::kGoalSucceeded, kHandle);
    if (!follows("reached", {msg::kTaskPregrasp}, profile_.decide_s, "obey object reached: request pregrasp"))
      return false;
  } else {
    report_.skip("reached", "pregrasp has begun already");
  }
  hand_->run(1.0);
  hand_->see_no_objects();
  hand_->report(msg::kEventObjectPregraspLost, msg::kGoalAborted, kHandle);
  if (!follows(
          "pregrasp_lost",
          {msg::kTaskSearchObject, msg::kTaskTrackObject, msg::kTaskExplore, msg::kTaskRotate, msg::kTaskFollowLine},
          profile_.decide_s, "obey object pregrasp lost: look for the object again"))
    return false;
  hand_->run(1.0);
  hand_->see(colour, msg::kBlobObject, kObject_m);
  if (hand_->newest()->task == msg::kTaskSearchObject)
    hand_->report(msg::kEventObjectFound, msg::kGoalSucceeded, kHandle);
  if (hand_->newest()->task != msg::kTaskTrackObject && !starts({msg::kTaskTrackObject}, profile_.turn_s)) return false;
  return check_delivery(0);
}

bool PlannerConformance::check_delivery(std::size_t index) {
  const std::uint8_t colour = mission_.sequence[index];
  const bool first = index == 0;
  hand_->run(1.0);
  hand_->report(msg::kEventObjectReached, msg::kGoalSucceeded, kHandle);
  if (!starts({msg::kTaskPregrasp}, profile_.decide_s)) return false;
  std::uint16_t handle = hand_->newest()->parameters.object_handle;
  hand_->run(1.0);
  hand_->report(msg::kEventObjectPregrasped, msg::kGoalSucceeded, kHandle);
  const bool grasps = starts({msg::kTaskGrasp}, profile_.decide_s);
  if (first) report_.judge("pregrasped", !grasps, newest(), "obey object pregrasped: request grasp");
  if (!grasps) return false;
  if (handle == 0 || handle == kHandle) handle = hand_->newest()->parameters.object_handle;
  if (first)
    report_.judge("handle", handle != 0 && handle != kHandle,
                  fmt::format("handle {}, for object {} of the map", handle, kHandle),
                  "copy TaskEvent.object_handle, or use 0: any object of the colour");
  hand_->run(1.0);
  hand_->carry(true);
  hand_->see_no_objects();
  hand_->report(msg::kEventObjectGrasped, msg::kGoalSucceeded, kHandle);
  const bool carries = starts({msg::kTaskFollowLine}, profile_.turn_s);
  if (first)
    report_.judge("carries", !carries, newest(),
                  "request follow_line, towards the zones, when the body holds the object");
  if (!carries) return false;
  hand_->run(profile_.way_s);
  hand_->map_zone(colour, kZone_m);
  hand_->see(colour, msg::kBlobZone, kZone_m);
  const bool drops =
      starts({msg::kTaskDrop}, profile_.decide_s) && hand_->newest()->parameters.drop_zone_colour == colour;
  if (first)
    report_.judge("drop", !drops, newest(),
                  "request drop with the colour of the object when some images show the zone and the map has it");
  if (!drops) return false;
  hand_->run(1.0);
  hand_->carry(false);
  hand_->run(1.0);
  hand_->map_on_zone(colour);
  hand_->see_no_objects();
  hand_->report(msg::kEventDroppingDone, msg::kGoalSucceeded);
  hand_->run(0.4);
  hand_->map_on_zone(colour);  // an image that was taken after the body left the object shows it, too
  const bool last = index + 1 == mission_.sequence.size();
  const bool counted = hand_->run(profile_.end_s, [&] {
    const msg::MissionStatus& mission = hand_->missions().back();
    return last ? mission.outcome != msg::kMissionRunning : mission.delivered_count > index;
  });
  const msg::MissionStatus& mission = hand_->missions().back();
  if (first)
    report_.judge(
        "delivered", !counted,
        fmt::format("delivered_count {}, state {}", mission.delivered_count, printable(text_of(mission.state))),
        "count an object in delivered_count when the map shows it on its zone after the drop");
  return counted || (last && !first);  // check_end() judges the end
}

void PlannerConformance::check_end() {
  std::string stuck;
  for (std::size_t index = 1; index < mission_.sequence.size() && stuck.empty(); ++index) {
    if (!brings_object_to(index))
      stuck = fmt::format("{} when the {} object is in view", newest(), colour_name(mission_.sequence[index]));
    else if (!check_delivery(index))
      stuck = fmt::format("{} while the {} object is delivered", newest(), colour_name(mission_.sequence[index]));
  }
  if (mission_.sequence.size() < 2) report_.skip("rest", "the mission has one object");
  else
    report_.pass_unless("rest", stuck, counted(mission_.sequence.size(), "object"),
                        "go on with the next object of the mission, in the same way");
  if (!stuck.empty()) return;
  const msg::MissionStatus mission = hand_->missions().back();
  hand_->run(1.0);
  const std::size_t later = requests_in(5.0);
  report_.judge("ends", mission.outcome != msg::kMissionSucceeded || later > 0,
                later > 0 ? fmt::format("{} tasks are started after the end", later)
                          : fmt::format("outcome {}, state {}", mission.outcome, printable(text_of(mission.state))),
                "set outcome to succeeded, cancel the running task, and request nothing more");
}

void PlannerConformance::check_form() {
  std::string wrong;
  std::uint64_t last_goal = 0;
  for (const msg::Request& request : hand_->requests()) {
    const std::string source = text_of(request.source);
    const bool named =
        !source.empty() && std::all_of(source.begin(), source.end(), [](char c) { return c > ' ' && c <= '~'; });
    if (!named) wrong = fmt::format("source '{}'", printable(source));
    if (request.level != msg::kAuthorityPlanner) wrong = fmt::format("level {}, not planner", request.level);
    if (request.kind != msg::kRequestTask || request.command != msg::kCommandStart) continue;
    if (request.goal_id <= last_goal) wrong = fmt::format("goal_id {} after {}", request.goal_id, last_goal);
    last_goal = request.goal_id;
    if (const auto refusal = task_parameter_refusal(request.task, request.parameters, request.path); !refusal.empty())
      wrong = fmt::format("{}: {}", task_name(request.task), refusal);
  }
  report_.pass_unless("form", wrong, counted(hand_->requests().size(), "request"),
                      "fill in the fields as idl/CLIENTS.md says; `input` refuses the request otherwise");
  const auto& ticks = hand_->request_ticks();
  std::size_t most = 0;
  for (std::size_t from = 0, to = 0; to < ticks.size(); ++to) {
    while (ticks[to] - ticks[from] >= 50) ++from;
    most = std::max(most, to - from + 1);
  }
  report_.judge("flood", most > static_cast<std::size_t>(profile_.most_requests), fmt::format("{} in a second", most),
                "wait for the answer of navigation before the next request");
  wrong.clear();
  const auto& missions = hand_->missions();
  if (missions.size() + 2 < hand_->ticks())
    wrong = fmt::format("{} messages in {} ticks", missions.size(), hand_->ticks());
  for (std::size_t i = 0; i < missions.size() && wrong.empty(); ++i) {
    const msg::MissionStatus& now = missions[i];
    if (now.object_count != mission_.sequence.size())
      wrong = fmt::format("{} objects, in a mission of {}", now.object_count, mission_.sequence.size());
    else if (now.object_index > now.object_count)
      wrong = fmt::format("object {} of {}", now.object_index, now.object_count);
    else if (now.delivered_count > now.object_count)
      wrong = fmt::format("{} of {} objects delivered", now.delivered_count, now.object_count);
    else if (now.outcome == msg::kMissionSucceeded && now.delivered_count < now.object_count)
      wrong = fmt::format("succeeded with {} of {} objects delivered", now.delivered_count, now.object_count);
    else if (now.object_index < mission_.sequence.size() && now.colour != mission_.sequence[now.object_index])
      wrong = fmt::format("object {} is {}", now.object_index, colour_name(now.colour));
    else if (text_of(now.state).empty()) wrong = "no state";
    if (i == 0 || !wrong.empty()) continue;
    const msg::MissionStatus& before = missions[i - 1];
    // The hand takes no delivered object off its zone, so the count does not fall.
    if (now.recoveries < before.recoveries || now.delivered_count < before.delivered_count)
      wrong = fmt::format("{} objects delivered and {} recoveries, after {} and {}", now.delivered_count,
                          now.recoveries, before.delivered_count, before.recoveries);
    if (before.outcome != msg::kMissionRunning && now.outcome != before.outcome) wrong = "the outcome changes";
  }
  report_.pass_unless("status", wrong, counted(missions.size(), "message"),
                      "write the state of the mission in every tick");
}

void PlannerConformance::check_epoch() {
  /// The requests of the first seconds of an epoch.
  const auto play = [&](const std::function<void()>& disturb) {
    port_.begin_epoch();
    hand_.emplace(port_);
    hand_->run(4.0);
    hand_->see_line(true);
    hand_->run(4.0);
    disturb();
    hand_->run(4.0);
    hand_->report(msg::kEventLineLost, msg::kGoalAborted);
    hand_->run(4.0);
    return hand_->requests();
  };
  const std::vector<msg::Request> first = play([] {});
  const std::vector<msg::MissionStatus> missions = hand_->missions();
  const bool fresh = !missions.empty() && missions.front().outcome == msg::kMissionRunning &&
                     missions.front().delivered_count == 0 && missions.front().object_index == 0 &&
                     missions.front().recoveries == 0;
  const std::uint64_t goal = first.empty() ? 0 : first.front().goal_id;
  report_.judge("epoch", !fresh || first.empty() || goal > 2,
                first.empty() ? std::string("no request in the new epoch")
                : !fresh      ? fmt::format("the mission goes on with outcome {} and {} objects delivered",
                                       missions.empty() ? 0 : missions.front().outcome,
                                       missions.empty() ? 0 : missions.front().delivered_count)
                              : fmt::format("begins with goal {}", goal),
                "construct the component anew at each EpochStart");
  const auto difference = [&](const std::vector<msg::Request>& second) -> std::string {
    if (first.size() != second.size()) return fmt::format("{} requests, then {}", first.size(), second.size());
    for (std::size_t i = 0; i < first.size(); ++i) {
      const msg::Request &a = first[i], &b = second[i];
      if (a.task != b.task || a.goal_id != b.goal_id || a.parameters.direction != b.parameters.direction ||
          a.header.tick != b.header.tick)
        return fmt::format("request {} differs", i);
    }
    return {};
  };
  const Repeat repeat = [&](const std::function<void()>& disturb) { return difference(play(disturb)); };
  judge_repetitions(report_, port_, repeat([] {}), repeat, fmt::format("{} requests are equal", first.size()));
}

}  // namespace constrictor::conform
