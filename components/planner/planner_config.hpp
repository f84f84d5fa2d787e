// The parameters of the planner: one row each. planner.yaml and the table in README.md follow from the rows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "component/mission.hpp"
#include "configuration/parameter_set.hpp"
#include "constrictor/constants.hpp"

namespace constrictor {

/// The names of colours by their constants; kColourUnknown is not accepted.
inline std::vector<std::string> colour_names() {
  auto names = names_of(constants::kColour);
  names[msg::kColourUnknown].clear();
  return names;
}

struct PlannerConfig : ParameterSet {
  std::vector<std::uint8_t> sequence =
      add(sequence, "sequence", {msg::kColourGreen, msg::kColourRed}, colour_names(), {0, 16},
          "Colours of the objects in the order of retrieval, unless the scenario states a mission. The planner drops "
          "each object on the zone of its colour; without colours it follows the line to its end");
  std::uint8_t line_colour = add(line_colour, "line_colour", msg::kColourBlue, colour_names(),
                                 "Colour of the line that the robot follows, unless the scenario states a mission");
  std::uint8_t zones_at = add(zones_at, "zones_at", kZonesAtBeginning, zones_at_names(),
                              "Where zones may lie, unless the scenario states it");
  double end_zone_m = add(end_zone_m, "end_zone_m", 2.0, "m", {0.0, 20.0}, kAtStart,
                          "An end of the line is among zones if one was nearer than this");
  double end_zone_s = add(end_zone_s, "end_zone_s", 3.0, "s", {0.0, 600.0}, kAtStart,
                          "Time within which that zone must have been seen");
  double end_search_s = add(end_search_s, "end_search_s", 30.0, "s", {1, 3600}, kAtStart,
                            "Time limit of search object where zones may be anywhere along the line");
  double object_probability = add(object_probability, "object_probability", 0.5, "", {0.0, 1.0}, kAtStart,
                                  "The planner approaches what is an object with at least this probability");
  int confirm_images = add(confirm_images, "confirm_images", 3, "images", {1, 100}, kAtStart,
                           "Consecutive images that must show the line, an object or a zone");
  double object_range_m = add(object_range_m, "object_range_m", 1.6, "m", {0.2, 20}, kAtStart,
                              "The robot approaches an object that is nearer than this");
  double zone_range_m = add(zone_range_m, "zone_range_m", 1.7, "m", {0.2, 20}, kAtStart,
                            "The robot drops an object on a zone that is nearer than this");
  double on_zone_m =
      add(on_zone_m, "on_zone_m", 0.6, "m", {0, 5}, kAtStart,
          "After a drop, the planner ignores an object that is nearer than this to the zone of its colour");
  double zone_radius_m = add(zone_radius_m, "zone_radius_m", kUsualZoneRadius_m, "m", kZoneRadiusBounds_m, kAtStart,
                             "Radius of a zone of which no image has shown the whole width");
  double seen_sd_m = add(seen_sd_m, "seen_sd_m", 0.12, "m", {0.01, 5}, kAtStart,
                         "A dropped object counts as seen when the standard deviation of its place is at most this");
  double inspect_s = add(inspect_s, "inspect_s", 20.0, "s", {1, 600}, kAtStart,
                         "Longest time of the look at a dropped object; then the likelier case counts");
  double step_back_s = add(step_back_s, "step_back_s", 2.0, "s", {0.1, 60}, kAtStart,
                           "The robot steps back for this time if it is too near to a dropped object to see its place");
  double last_look_s = add(last_look_s, "last_look_s", 1.0, "s", {0, 600}, kAtStart,
                           "Shortest look after the last drop: it shows whether the others are still on their zones");
  double approach_anew_s = add(approach_anew_s, "approach_anew_s", 6.0, "s", {1, 600}, kAtStart,
                               "Time for which the robot leaves an object before it approaches it in another way");
  int attempts = add(attempts, "attempts", 5, "", {1, 100}, kAtStart,
                     "Failures with an object after which it is put aside, and tried once more at the end");
  double remembered_range_m = add(remembered_range_m, "remembered_range_m", 2.5, "m", {0.3, 100}, kAtStart,
                                  "A search returns to an object or zone of the map that is nearer than this");
  double aligned_rad = add(aligned_rad, "aligned_rad", 1.0, "rad", {0.05, 1.5}, kAtStart,
                           "The robot faces the wanted direction along the line within this angle");
  double straight_rad = add(straight_rad, "straight_rad", 0.6, "rad", {0.05, 1.5}, kAtStart,
                            "A body whose head points away from it by more than this is too curled to follow a line");
  double explore_s = add(explore_s, "explore_s", 8.0, "s", {1, 600}, kAtStart,
                         "A search tries something else after exploring for this time");
  double rotate_s = add(rotate_s, "rotate_s", 10.0, "s", {1, 600}, kAtStart,
                        "A search tries something else after turning for this time");
  double sweep_m = add(sweep_m, "sweep_m", 2.0, "m", {0.2, 100}, kAtStart,
                       "Step of the growing square on which a robot with an object searches without a line");
  double any_way_s = add(any_way_s, "any_way_s", 15.0, "s", {0, 3600}, kAtStart,
                         "After searching for this time, a line that leads the wrong way is followed, too");
  double wrong_way_s = add(wrong_way_s, "wrong_way_s", 5.0, "s", {1, 600}, kAtStart,
                           "The robot turns round after following the line the wrong way for this time");
  double turning_room_m = add(turning_room_m, "turning_room_m", 2.0, "m", {0, 20}, kAtStart,
                              "With an object, the robot turns to a zone that is at least this far away");
  double room_m = add(room_m, "room_m", 0.2, "m", {0, 5}, kAtStart,
                      "Distance between obstacles and a free way to the line; nearer ones catch the arms of the U");
  double carry_room_m = add(carry_room_m, "carry_room_m", 0.3, "m", {0, 5}, kAtStart,
                            "Distance between obstacles and a free way with an object");
  double carry_ahead_m =
      add(carry_ahead_m, "carry_ahead_m", 0.3, "m", {0, 5}, kAtStart,
          "A search with an object backs off from an obstacle that is nearer than this before the head");
  double standstill_m =
      add(standstill_m, "standstill_m", 0.3, "m", {0.05, 100}, kAtStart,
          "A robot with an object counts as standing still while the object stays this near to one place");
  double standstill_s = add(standstill_s, "standstill_s", 30.0, "s", {1, 3600}, kAtStart,
                            "After this time a search leads the robot away: backwards, round, and forwards");
  double after_end_s = add(after_end_s, "after_end_s", 8.0, "s", {0, 600}, kAtStart,
                           "The planner ignores the line for this time after its end");
  double turn_round_s = add(turn_round_s, "turn_round_s", 20.0, "s", {1, 600}, kAtStart,
                            "Longest time of turning round without an object");
  double turn_back_s = add(turn_back_s, "turn_back_s", 40.0, "s", {1, 600}, kAtStart,
                           "Longest time of turning back to the line with an object, which takes a circle");
  double search_timeout_s = add(search_timeout_s, "search_timeout_s", 180.0, "s", {1, 3600}, kAtStart,
                                "A search for the line counts as a recovery after this time");
  double task_timeout_s = add(task_timeout_s, "task_timeout_s", 240.0, "s", {1, 3600}, kAtStart,
                              "Time limit of track, pregrasp, grasp and drop, each");
  double find_timeout_s = add(find_timeout_s, "find_timeout_s", 90.0, "s", {1, 3600}, kAtStart,
                              "An object that is not found within this time is put aside if there are others");
  double drop_timeout_s = add(drop_timeout_s, "drop_timeout_s", 120.0, "s", {1, 3600}, kAtStart,
                              "Time limit of nearing the zone; the robot then searches for it anew");
  double follow_timeout_s = add(follow_timeout_s, "follow_timeout_s", 120.0, "s", {1, 3600}, kAtStart,
                                "Time limit of following the line in one direction");
  double mission_timeout_s =
      add(mission_timeout_s, "mission_timeout_s", 3600.0, "s", {1, 86400}, kAtStart, "Time limit of the mission");
  double holding_factor = add(holding_factor, "holding_factor", 4.0, "", {1, 20}, kAtStart,
                              "Factor on the time limits of searching, turning and following with an object");
  double refused_pause_s = add(refused_pause_s, "refused_pause_s", 0.5, "s", {0.02, 60}, kAtStart,
                               "Pause after a refused request; it doubles with each further refusal");
  double refused_longest_pause_s = add(refused_longest_pause_s, "refused_longest_pause_s", 4.0, "s", {0.02, 600},
                                       kAtStart, "Longest pause between a refused request and the next one");
  double refused_timeout_s =
      add(refused_timeout_s, "refused_timeout_s", 120.0, "s", {1, 86400}, kAtStart,
          "The mission fails when navigation has accepted no request, or refused the same task, for this time");
  double suspended_timeout_s =
      add(suspended_timeout_s, "suspended_timeout_s", 3600.0, "s", {1, 86400}, kAtStart,
          "The mission fails after such a time of another source's authority, or of a latched stop");
  double blind_pause_s = add(blind_pause_s, "blind_pause_s", 3.0, "s", {0.2, 600}, kAtStart,
                             "The robot stands still after such a time without percepts, unless it grasps or drops");
  double blind_timeout_s = add(blind_timeout_s, "blind_timeout_s", 30.0, "s", {0.5, 86400}, kAtStart,
                               "The mission fails after such a time without percepts");
  int max_recoveries = add(max_recoveries, "max_recoveries", 60, "", {0, 10000}, kAtStart,
                           "The mission fails after more recoveries than this");

  /// Takes over what the mission states to be known beforehand.
  void know(const PriorKnowledge& known) {
    zone_radius_m = known.zone_radius_m.value_or(zone_radius_m);
    zones_at = known.zones_at.value_or(zones_at);
  }

  /// Takes over the time limits that the mission states.
  void keep(const TimeLimits& limits) {
    mission_timeout_s = limits.mission_s.value_or(mission_timeout_s);
    search_timeout_s = limits.search_s.value_or(search_timeout_s);
    follow_timeout_s = limits.follow_s.value_or(follow_timeout_s);
    find_timeout_s = limits.find_s.value_or(find_timeout_s);
    task_timeout_s = limits.task_s.value_or(task_timeout_s);
    drop_timeout_s = limits.drop_s.value_or(drop_timeout_s);
  }

  /// Checks what spans several rows. Throws ConfigurationError.
  void complete(const Configuration& root) const {
    if (blind_timeout_s <= blind_pause_s)
      throw root.error("blind_timeout_s", "found a time that is not longer than blind_pause_s");
    if (std::find(sequence.begin(), sequence.end(), line_colour) == sequence.end()) return;
    throw root.error("sequence", "found the line's colour, accepted other colours");
  }
};

/// The configuration from the planner's file, with what the mission states (Setup::mission). An empty mission leaves
/// the values of the file. Throws ConfigurationError.
[[nodiscard]] inline PlannerConfig load_planner_config(const std::filesystem::path& file, const std::string& mission) {
  auto config = load_parameters<PlannerConfig>(file);
  if (const std::optional<Mission> stated = parse_mission(mission)) {
    config.sequence = stated->sequence;
    config.line_colour = stated->line_colour;
    config.know(stated->known);
    config.keep(stated->limits);
  }
  return config;
}

}  // namespace constrictor
