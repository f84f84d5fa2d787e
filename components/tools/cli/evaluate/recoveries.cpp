#include "cli/evaluate/recoveries.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <regex>
#include <string_view>

#include "constrictor/messages.hpp"

namespace constrictor::cli {
namespace {

using nlohmann::json;

constexpr double kAtOnce_s = 0.1;      // the planner reacts to an event within a few ticks
constexpr double kGoesOn_s = 2.0;      // the mission goes on when it does so for this time
constexpr int kMostTimeLimits = 1000;  // in one stay: a damaged report must not fill the memory

struct Event {
  double at_s = 0;
  std::string name;
  std::string detail;
  std::string colour;
};

/// A recovery that the planner has counted, or may have counted.
struct Recovery {
  double at_s = 0;
  std::size_t stay = 0;  ///< the state that it ended, or in which it happened
  bool ended = true;     ///< the state ended
  std::string cause;
  bool guessed = false;  ///< no event shows it
};

template <std::size_t kSize>
bool among(const std::array<std::string_view, kSize>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 6> kSearching{"search line or object", "search object", "search line",
                                                     "approach anew",         "turn round",    "turn back"};
/// What follows when an object was lost; `failed`: it was put aside, and no other object is left.
constexpr std::array<std::string_view, 4> kAfterLostObject{"search object", "approach anew", "search line or object",
                                                           "failed"};

/// Whether the planner counts this change of its state as a recovery, if no request was refused. Source:
/// components/planner/mission_state.cpp and the calls of MissionPlanner::recover().
bool is_recovery(const std::string& from, const std::string& to) {
  const bool lost_object = among(kAfterLostObject, to);
  if (from == "search line or object") return to == "search line";
  if (from == "follow line") return to == "search line or object" || to == "search line" || to == "turn round";
  if (from == "search object") return to == "search line or object" || to == "search line" || to == "failed";
  if (from == "search line") return lost_object || to == "turn back";
  if (from == "follow line to drop zone") return lost_object || to == "search line" || to == "turn back";
  if (from == "drop") return lost_object || to == "search line";
  return lost_object && (from == "track object" || from == "pregrasp" || from == "grasp" || from == "inspect drop" ||
                         from == "turn back");
}

/// The events of the planner's own goals.
std::vector<Event> events_of(const json& report) {
  std::vector<Event> events;
  for (const auto& event : field(report, "events")) {
    const json& parameters = field(event, "parameters");
    const json& goal = field(parameters, "goal_id");
    if (!goal.is_number_integer() || goal.get<std::uint64_t>() >> 48 != msg::kAuthorityPlanner) continue;
    events.push_back({number_field(event, "sim_time_s"), text_field(event, "event"), text_field(parameters, "detail"),
                      text_field(parameters, "colour")});
  }
  return events;
}

/// Whether the planner gave up because it was left without objects that it may try, and not because a time limit of the
/// mission had passed. Source: MissionPlanner::end_of_sequence().
bool gave_up_objects(const json& report) {
  return text_field(report, "reason").find("not delivered: ") != std::string::npos;
}

/// Texts without numbers, so that equal causes are counted together.
std::string general(const std::string& text) {
  static const std::regex kNumber("-?[0-9]+(\\.[0-9]+)?");
  return std::regex_replace(text, kNumber, "#");
}

/// The failure that the events at the end of a state report; empty: none. The end of a goal says it more exactly than
/// the loss before it.
std::string reported_failure(const std::vector<Event>& at_end) {
  std::string failure;
  for (const Event& event : at_end) {
    const bool given_up = event.name == "goal_aborted" || event.name == "goal_cancelled";
    if (given_up && !event.detail.empty()) return general(event.detail);
    std::string words = event.name;
    std::replace(words.begin(), words.end(), '_', ' ');
    if (given_up) failure = "the task was given up";
    else if (event.name == "end_of_line" || event.name.ends_with("_lost")) failure = words;
  }
  return failure;
}

/// Whether the object that the robot turned to after `at_s` is another one than it had dropped last, so that it has
/// pushed a delivered one off its zone.
bool turns_to_another(const std::vector<Event>& events, double at_s) {
  std::string dropped, next;
  for (const Event& event : events) {
    if (event.name == "dropping_done" && event.at_s <= at_s) dropped = event.colour;
    const bool object = event.name == "object_found" || event.name == "object_reached";
    if (object && event.at_s > at_s && next.empty()) next = event.colour;
  }
  return !dropped.empty() && !next.empty() && dropped != next;
}

/// Why the robot searched for the object that it had dropped, in the words of MissionPlanner::after_drop() and
/// after_inspection(): the first of them goes on as soon as the map has the object outside its zone; the second one
/// waits for the end of the look, which has found the object or has taken its time. If that time is unknown, a look
/// without an end counts as one that has not seen the object on its zone.
const char* cause_after_drop(const StateStay& stay, const std::vector<Event>& at_end, const SearchLimits& limits) {
  const bool found = !at_end.empty() && at_end.back().name == "goal_succeeded";
  const bool in_time = std::isfinite(limits.inspect_s) && stay.end_s - stay.begin_s < limits.inspect_s - kAtOnce_s;
  return stay.state == "drop" || (in_time && !found) ? "the dropped object was seen outside its zone"
                                                     : "the dropped object was not seen on its zone";
}

/// The cause of a recovery that no event reports. `at_end`: the events at the end of the stay.
std::string silent_cause(const StateStay& stay, const std::string& to, const std::vector<Event>& events,
                         const std::vector<Event>& at_end, const SearchLimits& limits) {
  const bool object = among(kAfterLostObject, to);
  const bool dropped = stay.state == "inspect drop" || stay.state == "drop";
  if (dropped && object) {
    return turns_to_another(events, stay.end_s) ? "a delivered object was pushed off its zone"
                                                : cause_after_drop(stay, at_end, limits);
  }
  if (to == "turn back") return "the line leads the wrong way";
  if (to == "turn round") return "the robot followed the line the wrong way";
  const bool holding = stay.state == "search line" || stay.state == "turn back" ||
                       stay.state == "follow line to drop zone" || stay.state == "drop";
  if (holding && object) return "the robot held no object";
  if (holding) return "it stood still, or its time limit passed";
  return to == "search line" ? "the robot held an object" : "its time limit passed";
}

/// The recoveries of one stay, in the order of their times. `gave_up`: see gave_up_objects().
void add_recoveries(const std::vector<StateStay>& stays, std::size_t index, const std::vector<Event>& events,
                    const SearchLimits& limits, bool gave_up, std::vector<Recovery>& found) {
  const StateStay& stay = stays[index];
  std::vector<Event> at_end;
  const bool searches_line = stay.state == "search line" || stay.state == "search line or object";
  const double limit_s = stay.state == "search line" ? limits.holding_s : limits.empty_s;
  for (int i = 1; searches_line && i * limit_s < stay.end_s - stay.begin_s && i < kMostTimeLimits; ++i)
    found.push_back({stay.begin_s + i * limit_s, index, false, stay.state + ": its time limit passed", true});
  const bool last = index + 1 == stays.size();
  for (const Event& event : events) {
    if (event.at_s <= stay.begin_s || event.at_s > stay.end_s + 1e-6) continue;
    if (!last && stay.end_s - event.at_s < kAtOnce_s) at_end.push_back(event);
    else if (searches_line && event.name == "goal_aborted")
      found.push_back({event.at_s, index, false, stay.state + ": " + reported_failure({event}), false});
  }
  if (last) return;
  const std::string& to = stays[index + 1].state;
  const bool refused =
      std::any_of(at_end.begin(), at_end.end(), [](const Event& e) { return e.name == "goal_refused"; });
  if (refused || !is_recovery(stay.state, to)) return;
  const std::string reported = reported_failure(at_end);
  if (to == "failed" && reported.empty() && !gave_up) return;  // a time limit of the mission
  const std::string cause = reported.empty() ? silent_cause(stay, to, events, at_end, limits) : reported;
  // The planner may have failed because there were too many recoveries; then it does not count the last one.
  found.push_back({stay.end_s, index, true, stay.state + ": " + cause, reported.empty() || to == "failed"});
}

/// Leaves as many as the planner has counted. Those that no event shows go first, from the end.
void keep(std::vector<Recovery>& found, std::size_t count) {
  while (found.size() > count) {
    const auto guessed = std::find_if(found.rbegin(), found.rend(), [](const Recovery& r) { return r.guessed; });
    found.erase(guessed == found.rend() ? found.end() - 1 : guessed.base() - 1);
  }
}

RecoveryTime longest(const std::vector<StateStay>& stays, const std::vector<Recovery>& found) {
  RecoveryTime longest, now;
  double until_s = -std::numeric_limits<double>::infinity();
  for (const Recovery& recovery : found) {
    // A search that has failed has begun before that.
    const double begin_s = recovery.ended ? recovery.at_s : stays[recovery.stay].begin_s;
    std::size_t next = recovery.stay + 1;
    while (next < stays.size() && among(kSearching, stays[next].state)) ++next;
    if (begin_s - until_s >= kGoesOn_s) now = {begin_s, 0, recovery.cause};
    until_s = std::max({until_s, begin_s, next < stays.size() ? stays[next].begin_s : stays.back().end_s});
    now.duration_s = until_s - now.begin_s;
    if (!(now.duration_s <= longest.duration_s)) longest = now;
  }
  return longest;
}

}  // namespace

std::vector<StateStay> stays_of(const json& report, double end_s) {
  std::vector<StateStay> stays;
  const json& states = field(report, "states");
  if (!states.is_array()) return stays;
  for (const auto& entry : states) {
    const double begin_s = number_field(entry, "sim_time_s");
    if (!std::isfinite(begin_s)) continue;
    if (!stays.empty()) stays.back().end_s = std::max(begin_s, stays.back().begin_s);
    stays.push_back({text_field(entry, "state"), begin_s, std::max(begin_s, end_s)});
  }
  return stays;
}

Recoveries recoveries_of(const json& report, double end_s, const SearchLimits& limits) {
  const std::vector<StateStay> stays = stays_of(report, end_s);
  const std::vector<Event> events = events_of(report);
  const int counted = count_field(report, "recoveries");
  const bool gave_up = gave_up_objects(report);
  std::vector<Recovery> found;
  for (std::size_t i = 0; i < stays.size(); ++i) add_recoveries(stays, i, events, limits, gave_up, found);
  keep(found, static_cast<std::size_t>(counted));
  Recoveries recoveries;
  for (const Recovery& recovery : found) ++recoveries.by_cause[recovery.cause];
  const int others = counted - static_cast<int>(found.size());
  if (others > 0) recoveries.by_cause["other"] = others;
  std::stable_sort(found.begin(), found.end(), [](const Recovery& a, const Recovery& b) { return a.stay < b.stay; });
  recoveries.longest = longest(stays, found);
  return recoveries;
}

}  // namespace constrictor::cli
