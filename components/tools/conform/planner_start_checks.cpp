// Checks of a planner until it sees an object: search, the line, refused and lost requests, authority, stops.
#include <fmt/format.h>

#include <algorithm>

#include "configuration/configuration.hpp"
#include "configuration/counted.hpp"
#include "conform/part_restart.hpp"
#include "conform/planner_conformance.hpp"

namespace constrictor::conform {

std::vector<Check> planner_checks() {
  return {
      {"arrives", "mission_status begins soon", {}, {}, {}},
      {"search", "a search begins when nothing is seen", {}, {}, {}},
      {"line", "the line is followed when it is seen", {}, {}, {}},
      {"line_colour", "the line has the colour of the mission", {}, {}, {}},
      {"line_lost", "a search begins when the line was lost", {}, {}, {}},
      {"refused", "the planner goes on when a request was refused", {}, {}, {}},
      {"lost_request", "a request that was lost is made again", {}, {}, {}},
      {"authority", "nothing is requested while an operator has authority", {}, {}, {}},
      {"returns", "the mission goes on when authority returns", {}, {}, {}},
      {"stop", "nothing is requested during an emergency stop", {}, {}, {}},
      {"other_object", "an object that is not the next one of the mission is left alone", {}, {}, {}},
      {"object", "the next object of the mission is tracked when it is seen", {}, {}, {}},
      {"wrong_goal", "events of other goals are not obeyed", {}, {}, {}},
      {"reached", "pregrasp follows object reached", {}, {}, {}},
      {"pregrasp_lost", "the object is looked for after object pregrasp lost", {}, {}, {}},
      {"pregrasped", "grasp follows object pregrasped", {}, {}, {}},
      {"handle", "pregrasp and grasp name the handle of the event, or 0", {}, {}, {}},
      {"carries", "the object is carried to the line", {}, {}, {}},
      {"drop", "the object is dropped on the zone of its colour when this is seen", {}, {}, {}},
      {"delivered", "mission_status counts the object after dropping done, seen on its zone", {}, {}, {}},
      {"rest", "the other objects follow in the order of the mission", {}, {}, {}},
      {"ends", "the mission succeeds after the last object, and requests end", {}, {}, {}},
      {"form", "each request has a level, a source, a rising goal_id, a task and its parameters", {}, {}, {}},
      {"flood", "there are few requests in any second", {}, {}, {}},
      {"status", "one mission_status in each tick, which agrees with the mission and never goes back", {}, {}, {}},
      {"epoch", "a new epoch begins without memory", {}, {}, {}},
      {"repeatable", "the same messages give the same requests in the next epoch", {}, {}, {}},
      restart_check(),
  };
}

Mission mission_of(const std::string& yaml) {
  return parse_mission(yaml).value_or(Mission{{msg::kColourGreen, msg::kColourRed}, msg::kColourBlue, {}, {}});
}

void PlannerConformance::run() {
  if (!check_arrival() || !check_line()) {
    report_.skip_rest("the mission does not come so far");
    return;
  }
  check_lost_requests();
  check_authority();
  if (check_object()) check_end();
  check_form();
  check_epoch();
  if (mission_.sequence.empty()) return report_.skip_rest("the mission names no object");
  // A step of the mission that no check judges has failed: the next check is to blame.
  for (std::size_t i = 0; report_.count(Verdict::kFailed) == 0 && i < report_.checks().size(); ++i) {
    if (report_.checks()[i].verdict == Verdict::kNotChecked)
      report_.fail(report_.checks()[i].name, "the mission does not come so far, last request: " + newest(),
                   "go on after the event before");
  }
  report_.skip_rest("the mission does not come so far");
}

std::string PlannerConformance::newest() const {
  const msg::Request* request = hand_->newest();
  if (request == nullptr) return "no request";
  std::string text = task_name(request->task);
  if (request->parameters.line_colour) text += fmt::format(", line {}", colour_name(request->parameters.line_colour));
  if (request->parameters.object_colour)
    text += fmt::format(", {} object", colour_name(request->parameters.object_colour));
  if (request->parameters.drop_zone_colour)
    text += fmt::format(", {} zone", colour_name(request->parameters.drop_zone_colour));
  return text;
}

bool PlannerConformance::starts(Tasks tasks, double seconds) {
  std::size_t seen = hand_->requests().size();
  return hand_->run(seconds, [&] {
    for (; seen < hand_->requests().size(); ++seen) {
      const msg::Request& request = hand_->requests()[seen];
      if (request.kind != msg::kRequestTask || request.command != msg::kCommandStart) continue;
      if (std::find(tasks.begin(), tasks.end(), request.task) != tasks.end()) return true;
    }
    return false;
  });
}

bool PlannerConformance::follows(const char* check, Tasks tasks, double seconds, const char* todo) {
  const bool found = starts(tasks, seconds);
  report_.judge(check, !found, found ? newest() : fmt::format("{}, after {} s", newest(), seconds), todo);
  return found;
}

std::size_t PlannerConformance::requests_in(double seconds) {
  const std::size_t before = hand_->requests().size();
  hand_->run(seconds);
  return static_cast<std::size_t>(
      std::count_if(hand_->requests().begin() + static_cast<long>(before), hand_->requests().end(),
                    [](const msg::Request& request) { return request.command == msg::kCommandStart; }));
}

bool PlannerConformance::check_arrival() {
  const bool arrived = hand_->run(profile_.patience_s, [&] { return !hand_->missions().empty(); });
  report_.judge("arrives", !arrived,
                arrived ? "after " + counted(hand_->ticks(), "tick")
                        : fmt::format("no mission_status within {} s", profile_.patience_s),
                "write mission_status in every tick");
  if (!arrived) return false;
  const bool asked = hand_->newest() != nullptr ||
                     starts({msg::kTaskExplore, msg::kTaskRotate, msg::kTaskSearchObject}, profile_.decide_s);
  const std::uint8_t task = asked ? hand_->newest()->task : msg::kTaskNone;
  const bool searches = task == msg::kTaskExplore || task == msg::kTaskRotate || task == msg::kTaskSearchObject;
  report_.judge("search", !searches, newest(), "request explore or rotate while neither line nor object is in view");
  return asked;
}

bool PlannerConformance::check_line() {
  hand_->see_line(true);
  if (!follows("line", {msg::kTaskFollowLine}, profile_.decide_s, "request follow_line when some images show the line"))
    return false;
  const std::uint8_t colour = hand_->newest()->parameters.line_colour;
  report_.judge("line_colour", colour != mission_.line_colour,
                fmt::format("{}, in a mission with a {} line", colour_name(colour), colour_name(mission_.line_colour)),
                "take it from the option --mission, or from the planner's configuration");
  hand_->run(2.0);
  hand_->see_line(false);
  hand_->run(0.5);
  hand_->report(msg::kEventLineLost, msg::kGoalAborted);
  follows("line_lost", {msg::kTaskExplore, msg::kTaskRotate, msg::kTaskSearchObject}, profile_.decide_s,
          "obey the event line lost, and request explore or rotate");
  return true;
}

void PlannerConformance::check_lost_requests() {
  hand_->answer = PlannerHand::Answer::kRefuse;
  hand_->see_line(true);
  bool again = starts({msg::kTaskFollowLine}, profile_.decide_s);
  again = again && requests_in(profile_.repeat_s) > 0;
  report_.judge("refused", !again, again ? newest() : "no request after the refusal",
                "read task/event: goal_state refused ends a goal, too");
  hand_->answer = PlannerHand::Answer::kIgnore;
  hand_->see_line(false);
  hand_->run(0.5);
  hand_->report(msg::kEventLineLost, msg::kGoalAborted);
  hand_->run(0.5);  // in which it is requested for the first time
  const std::size_t repeated = requests_in(profile_.repeat_s);
  hand_->answer = PlannerHand::Answer::kTake;
  report_.judge("lost_request", repeated == 0,
                fmt::format("{} requests in {} s, none of which is taken", repeated, profile_.repeat_s),
                "compare task/status.goal_id with the goal that was requested, and request it again");
  hand_->run(profile_.repeat_s);
}

void PlannerConformance::check_authority() {
  hand_->give_authority(msg::kAuthorityOperator);
  hand_->run(0.2);
  hand_->report(msg::kEventNone, msg::kGoalCancelled);
  const std::size_t meanwhile = requests_in(profile_.decide_s);
  report_.judge("authority", meanwhile > 0, fmt::format("{} in {} s", counted(meanwhile, "request"), profile_.decide_s),
                "read authority, and request nothing while its level is above the planner's");
  hand_->give_authority(msg::kAuthorityNone);
  const std::size_t again = requests_in(profile_.repeat_s);
  report_.judge("returns", again == 0, fmt::format("{} in {} s", counted(again, "request"), profile_.repeat_s),
                "request the task of the present state anew when the level is none again");
  hand_->give_authority(msg::kAuthorityEmergencyStop, true);
  hand_->run(0.2);
  hand_->report(msg::kEventNone, msg::kGoalCancelled);
  const std::size_t stopped = requests_in(profile_.decide_s);
  // An operator clears the stop, takes over and releases: only then may the planner go on.
  hand_->give_authority(msg::kAuthorityOperator);
  hand_->run(0.5);
  hand_->give_authority(msg::kAuthorityNone);
  const std::size_t resumed = requests_in(profile_.repeat_s);
  report_.judge("stop", stopped > 0 || resumed == 0,
                stopped > 0 ? fmt::format("{} in {} s", counted(stopped, "request"), profile_.decide_s)
                            : fmt::format("none; {} after an operator has released authority", resumed),
                "read authority.emergency_stop, and go on when an operator has returned authority");
}

}  // namespace constrictor::conform
