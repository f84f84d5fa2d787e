// The parameters of navigation: one row each. navigation.yaml and the table in README.md follow from the rows.
#pragma once

#include <cstdint>

#include "component/mission.hpp"
#include "navigation/grip_config.hpp"
#include "navigation/line_tracker.hpp"
#include "navigation/navigation_section.hpp"
#include "navigation/object_tracker.hpp"
#include "navigation/sliding_steering.hpp"

namespace constrictor {

inline constexpr std::uint8_t kSteerByPid = 0;          ///< FollowLineConfig::law
inline constexpr std::uint8_t kSteerBySlidingMode = 1;  ///< FollowLineConfig::law

struct FollowLineConfig : NavigationSection {
  std::uint8_t law = add(law, "law", kSteerByPid, {"pid", "sliding_mode"}, kWhileRunning,
                         "Law from what the camera shows of the line to the curvature of the path");
  PidGains steering = add(steering, "steering", {3.0, 0.4, 1.0, 1.2, 0.2}, kWhileRunning, "line's offset [m]");
  SlidingSteeringConfig sliding = add_section(sliding, "sliding_mode");
  double carry_limit_1_m = add(carry_limit_1_m, "carry_limit_1_m", 1.0, "1/m", bounds::kCurvature, kWhileRunning,
                               "Bound of the curvature while the robot carries an object");
  double carry_room_m = add(carry_room_m, "carry_room_m", 0.25, "m", bounds::kLength, kWhileRunning,
                            "Wanted distance between the arms of the U and obstacles of the map");
  double carry_ahead_m = add(carry_ahead_m, "carry_ahead_m", 1.2, "m", bounds::kLength, kWhileRunning,
                             "Obstacles count up to this distance ahead of the foremost module");
  double end_reached_m = add(end_reached_m, "end_reached_m", 0.35, "m", bounds::kLength, kWhileRunning,
                             "Distance of the head from the end of the line at which the end is reached");
  int end_images = add(end_images, "end_images", 3, "images", {1, 100}, kAtStart,
                       "Consecutive images that must show the end of the line");
};

struct FollowPathConfig : ParameterSet {
  double reached_m = add(reached_m, "reached_m", 0.1, "m", bounds::kLength, kWhileRunning,
                         "The path ends this far before its last point");
  double lost_m = add(lost_m, "lost_m", 1.0, "m", bounds::kLength, kAtStart,
                      "A goal is refused or aborted farther than this from its path");
};

struct SearchConfig : ParameterSet {
  double head_turn_rad = add(head_turn_rad, "head_turn_rad", 0.9, "rad", bounds::kAngle, kAtStart,
                             "Angle by which the head looks to each side, in total over its three joints");
  double head_rate_rad_s = add(head_rate_rad_s, "head_rate_rad_s", 0.25, "rad/s", bounds::kSpeed, kWhileRunning,
                               "Speed of each joint that turns the head");
  double near_m = add(near_m, "near_m", 0.7, "m", bounds::kLength, kAtStart,
                      "The body leaves a remembered object that is nearer than this before it turns");
  double remembered_m = add(remembered_m, "remembered_m", 3.0, "m", bounds::kLength, kAtStart,
                            "The robot does not return to a remembered object that is farther away than this");
  double advance_m =
      add(advance_m, "advance_m", 0.5, "m", bounds::kLength, kAtStart, "Distance driven between two looks");
  double turn_rad = add(turn_rad, "turn_rad", 1.6, "rad", bounds::kAngle, kAtStart,
                        "Angle of the turn on the spot after every second look");
  double turn_curvature_1_m = add(turn_curvature_1_m, "turn_curvature_1_m", 2.3, "1/m", bounds::kCurvature, kAtStart,
                                  "Curvature of turns on the spot");
  double confirm_s =
      add(confirm_s, "confirm_s", 0.5, "s", bounds::kTime, kAtStart, "The object must stay in view for this time");
};

struct TrackConfig : NavigationSection {
  PidGains steering = add(steering, "steering", {2.5, 0.2, 0.0, 1.3, 0.2}, kWhileRunning, "object's bearing [rad]");
  double reach_m = add(reach_m, "reach_m", 0.9, "m", bounds::kLength, kWhileRunning,
                       "Distance from the head to the object's surface at which the object is reached");
  double reach_bearing_rad = add(reach_bearing_rad, "reach_bearing_rad", 0.3, "rad", bounds::kAngle, kAtStart,
                                 "Largest bearing of a reached object");
  double straight_rad = add(straight_rad, "straight_rad", 0.5, "rad", bounds::kAngle, kAtStart,
                            "The body, too, must point to a reached object within this angle");
  double too_near_m = add(too_near_m, "too_near_m", 0.45, "m", bounds::kLength, kAtStart,
                          "The body moves away from an object that is nearer than this");
  double turn_radius_m = add(turn_radius_m, "turn_radius_m", 0.55, "m", {0.05, 10.0}, kAtStart,
                             "Radius of the head's path in turns on the spot: the body moves away until the turn fits");
  double leave_timeout_s = add(leave_timeout_s, "leave_timeout_s", 20.0, "s", bounds::kTime, kAtStart,
                               "The body moves away for at most this time");
  double turn_rad = add(turn_rad, "turn_rad", 1.0, "rad", bounds::kAngle, kAtStart,
                        "The body turns on the spot towards an object with a larger bearing");
  double turn_curvature_1_m = add(turn_curvature_1_m, "turn_curvature_1_m", 2.3, "1/m", bounds::kCurvature, kAtStart,
                                  "Curvature of turns on the spot");
  double memory_s = add(memory_s, "memory_s", 20.0, "s", bounds::kTime, kAtStart,
                        "The body drives towards an object out of view for at most this time");
  double half_view_rad = add(half_view_rad, "half_view_rad", 0.7, "rad", bounds::kAngle, kAtStart,
                             "An object within this bearing should be in view");
};

struct RotateConfig : ParameterSet {
  double curvature_1_m = add(curvature_1_m, "curvature_1_m", 2.3, "1/m", bounds::kCurvature, kWhileRunning,
                             "Curvature of turns on the spot");
  double carry_curvature_1_m = add(carry_curvature_1_m, "carry_curvature_1_m", 1.0, "1/m", bounds::kCurvature, kAtStart,
                                   "Curvature of turns with an object in the U");
};

struct ExploreConfig : ParameterSet {
  double head_turn_rad = add(head_turn_rad, "head_turn_rad", 0.9, "rad", bounds::kAngle, kAtStart,
                             "Angle by which the head looks to each side, in total over its three joints");
  double head_rate_rad_s = add(head_rate_rad_s, "head_rate_rad_s", 0.25, "rad/s", bounds::kSpeed, kAtStart,
                               "Speed of each joint that turns the head");
  double step_m = add(step_m, "step_m", 0.5, "m", bounds::kLength, kAtStart, "Length of a step of the body");
  double carry_turn_rad = add(carry_turn_rad, "carry_turn_rad", 0.3, "rad", bounds::kAngle, kAtStart,
                              "The same as head_turn_rad with an object in the U");
};

struct PregraspConfig : NavigationSection {
  double seen_within_s = add(seen_within_s, "seen_within_s", 3.0, "s", bounds::kTime, kAtStart,
                             "The object must have been in view within this time before the start");
  double clearance_m = add(clearance_m, "clearance_m", 0.05, "m", bounds::kLength, kWhileRunning,
                           "Distance between body and object while the body passes the object");
  PidGains steering =
      add(steering, "steering", {5.0, 0.0, 0.0, 1.3, 0.2}, kAtStart, "distance from the passing line [m]");
  double lookahead_m = add(lookahead_m, "lookahead_m", 0.3, "m", bounds::kLength, kAtStart,
                           "The robot steers towards the point of the passing line this far ahead");
  double past_m = add(past_m, "past_m", 0.2, "m", bounds::kLength, kAtStart,
                      "Distance by which the head passes the object's centre before the touch movement");
  double brake_m = add(brake_m, "brake_m", 0.12, "m", bounds::kLength, kAtStart,
                       "Distance that the body slides after the wave stops");
  double settle_s = add(settle_s, "settle_s", 0.8, "s", bounds::kTime, kAtStart,
                        "The body stands for this time before the touch movement");
  double touch_rate_rad_s = add(touch_rate_rad_s, "touch_rate_rad_s", 0.12, "rad/s", bounds::kSpeed, kAtStart,
                                "Speed of each of the three joints that bend in the touch movement");
  double touch_limit_rad = add(touch_limit_rad, "touch_limit_rad", 0.3, "rad", bounds::kAngle, kAtStart,
                               "Largest angle of each of these joints");
  double touch_further_rad = add(touch_further_rad, "touch_further_rad", 0.1, "rad", bounds::kAngle, kAtStart,
                                 "Increase of touch_limit_rad after each attempt without a touch");
  double touch_force_n = add(touch_force_n, "touch_force_n", 0.4, "N", bounds::kForce, kWhileRunning,
                             "Force that ends the touch movement");
  double deep_min_m =
      add(deep_min_m, "deep_min_m", -0.4, "m", {-2.0, 1.0}, kAtStart,
          "Rearmost accepted place of the object's centre along the body, from the head (behind it is negative)");
  double deep_max_m = add(deep_max_m, "deep_max_m", -0.12, "m", {-1.0, 1.0}, kAtStart,
                          "Foremost accepted place; the bending head would push an object farther ahead away");
  int attempts = add(attempts, "attempts", 4, "", bounds::kCount, kAtStart, "Maximum number of touch movements");
  double other_clearance_m = add(other_clearance_m, "other_clearance_m", 0.3, "m", bounds::kLength, kAtStart,
                                 "Wanted distance between the manoeuvre and other objects");
};

/// How a robot with an object steers back to the line of the map that its camera does not see.
struct BackToLineConfig : NavigationSection {
  PidGains steering = add(steering, "steering", {3.0, 0.0, 0.0, 1.0, 0.2}, kWhileRunning, "offset of the line [m]");
  double lookahead_m = add(lookahead_m, "lookahead_m", 0.6, "m", bounds::kLength, kAtStart,
                           "The head steers to the place of the line so far ahead");
  double aside_m = add(aside_m, "aside_m", 1.0, "m", bounds::kLength, kAtStart,
                       "A line that is farther aside is approached slantwise");
  double reach_m = add(reach_m, "reach_m", 2.0, "m", bounds::kLength, kAtStart,
                       "A line that begins farther ahead is not steered to");
};

struct GraspConfig : NavigationSection {
  double wrap_speed_m_s = add(wrap_speed_m_s, "wrap_speed_m_s", 0.34, "m/s", bounds::kSpeed, kAtStart,
                              "Speed of the arc along the body at the beginning; later it is the speed of the body");
  double wrap_still_m = add(wrap_still_m, "wrap_still_m", 0.3, "m", bounds::kLength, kAtStart,
                            "The body begins to move after the arc has slid this far");
  double wrap_speed_min_m_s =
      add(wrap_speed_min_m_s, "wrap_speed_min_m_s", 0.24, "m/s", bounds::kSpeed, kAtStart, "Smallest speed of the arc");
  double wrap_speed_max_m_s =
      add(wrap_speed_max_m_s, "wrap_speed_max_m_s", 0.35, "m/s", bounds::kSpeed, kAtStart, "Largest speed of the arc");
  double wrap_speed_filter_s = add(wrap_speed_filter_s, "wrap_speed_filter_s", 1.0, "s", {0.02, 60.0}, kAtStart,
                                   "Time constant of the low-pass on the body's speed");
  double wrap_m_s = add_speed(wrap_m_s, "wrap.speed_m_s", 0.28, kAtStart, "Speed of the body in the wrap");
  double seat_m_s =
      add_speed(seat_m_s, "seat.speed_m_s", 0.165, kAtStart, "Speed at which the base drives to the object");
  double squeeze_m_s = add_speed(squeeze_m_s, "squeeze.speed_m_s", 0.098, kAtStart, "Speed of the body in the squeeze");
  double touch_memory_s = add(touch_memory_s, "touch_memory_s", 3.0, "s", bounds::kTime, kAtStart,
                              "A touch counts for this time, because the gait interrupts touches");
  double seat_force_n = add(seat_force_n, "seat_force_n", 0.4, "N", bounds::kForce, kWhileRunning,
                            "Force in the middle of the base that shows that the object touches it");
  double seat_time_s = add(seat_time_s, "seat_time_s", 1.0, "s", bounds::kTime, kAtStart,
                           "Duration of this force after which the squeeze begins");
  double seat_timeout_s = add(seat_timeout_s, "seat_timeout_s", 20.0, "s", bounds::kTime, kAtStart,
                              "The grasp is given up if the base does not touch the object within this time");
  double unfelt_seat_s = add(unfelt_seat_s, "unfelt_seat_s", 5.0, "s", bounds::kTime, kWhileRunning,
                             "Duration of the seat for a robot without contact sensors");
  double squeeze_max_rad = add(squeeze_max_rad, "squeeze_max_rad", 0.9, "rad", bounds::kAngle, kAtStart,
                               "Largest closing angle, summed over the base joints");
  double squeeze_settle_s = add(squeeze_settle_s, "squeeze_settle_s", 1.0, "s", bounds::kTime, kAtStart,
                                "The torque of the squeeze counts after this time: the larger wave of the seat has "
                                "faded by then");
  double squeeze_torque_nm = add(squeeze_torque_nm, "squeeze_torque_nm", 3.0, "Nm", bounds::kTorque, kWhileRunning,
                                 "Closing torque of a base joint at which the object is held");
  double squeeze_cap_nm = add(squeeze_cap_nm, "squeeze_cap_nm", 6.0, "Nm", bounds::kTorque, kWhileRunning,
                              "Maximum torque of the base joints during the squeeze");
  int squeeze_attempts = add(squeeze_attempts, "squeeze_attempts", 3, "", bounds::kCount, kAtStart,
                             "Maximum number of squeezes; the body drives on between two of them");
  int touching_modules = add(touching_modules, "touching_modules", 2, "", {0, 20}, kAtStart,
                             "Number of modules that must touch a held object");
  double check_s = add(check_s, "check_s", 2.0, "s", bounds::kTime, kAtStart, "Duration of the check of the hold");
};

struct DropConfig : NavigationSection {
  PidGains steering = add(steering, "steering", {3.0, 0.4, 0.0, 1.6, 0.2}, kWhileRunning, "distance to the course [m]");
  double brake_m = add(brake_m, "brake_m", 0.03, "m", bounds::kLength, kAtStart,
                       "Distance that the object slides after the wave stops");
  double room_m = add(room_m, "room_m", 0.08, "m", bounds::kLength, kAtStart,
                      "Distance to another object on the zone before which the object is let go");
  double lookahead_m = add(lookahead_m, "lookahead_m", 1.3, "m", bounds::kLength, kWhileRunning,
                           "Distance ahead of the object at which the point lies that the robot steers to the course");
  double pivot_m = add(pivot_m, "pivot_m", 0.3, "m", bounds::kLength, kWhileRunning,
                       "Distance from the object to the point of the U that does not move sideways when the U turns");
  double crab_filter_s = add(crab_filter_s, "crab_filter_s", 2.0, "s", {0.02, 600.0}, kWhileRunning,
                             "Time constant of the low-pass on the angle between the course and the U on a slope");
  double open_angle_rad = add(open_angle_rad, "open_angle_rad", 0.873, "rad", bounds::kAngle, kAtStart,
                              "Angle of each base joint when the U releases the object");
  double open_s = add(open_s, "open_s", 1.2, "s", {0.1, 60.0}, kAtStart, "Duration of the opening");
  double back_m_s =
      add_speed(back_m_s, "back.speed_m_s", 0.24, kAtStart, "Speed at which the open U leaves the object");
  PidGains back_steering =
      add(back_steering, "back_steering", {5.0, 0.0, 0.0, 1.0, 0.2}, kWhileRunning, "distance from the object [m]");
  double back_m =
      add(back_m, "back_m", 1.05, "m", bounds::kLength, kAtStart, "Distance by which the robot backs off afterwards");
  double back_timeout_s =
      add(back_timeout_s, "back_timeout_s", 20.0, "s", bounds::kTime, kAtStart, "Longest time of each backing off");
  double clear_m =
      add(clear_m, "clear_m", 0.6, "m", bounds::kLength, kAtStart,
          "Distance by which the straight robot backs off then, so that its turns do not reach the object");
  double straighten_rate_rad_s = add(straighten_rate_rad_s, "straighten_rate_rad_s", 0.8, "rad/s", bounds::kSpeed,
                                     kAtStart, "Speed of each joint when the body straightens");
};

struct NavigationConfig : NavigationSection {
  double travel_m_s = add_speed(travel_m_s, "travel.speed_m_s", 0.63, kWhileRunning, "Speed without an object");
  double carry_m_s = add_speed(carry_m_s, "carry.speed_m_s", 0.264, kWhileRunning,
                               "Speed along a line or path with an object in the U");
  double deliver_m_s = add_speed(deliver_m_s, "deliver.speed_m_s", 0.187, kWhileRunning,
                                 "Speed with an object in the U while the robot searches, turns, and nears a zone");
  bool carries_on_ground = false;  ///< the robot cannot raise the base of its U; set by navigation_fitted_to()
  double creep_m_s =
      add_speed(creep_m_s, "creep.speed_m_s", 0.28, kWhileRunning, "Speed of small steps beside an object");
  std::int64_t stale_after_ticks = add(stale_after_ticks, "stale_after_ticks", 25, "ticks", {2, 10000}, kAtStart,
                                       "The robot stands still when joints, contacts or pose are older than this");
  std::int64_t blind_after_images =
      add(blind_after_images, "blind_after_images", 15, "images", {2, 10000}, kAtStart,
          "Tasks that steer by sight stand still when as many images have brought no percepts");
  LineTrackerConfig line = add_section(line, "line_tracker");
  ObjectTrackerConfig object = add_section(object, "object_tracker");
  GripConfig grip = add_section(grip, "grip");
  FollowLineConfig follow_line = add_section(follow_line, "follow_line");
  BackToLineConfig back_to_line = add_section(back_to_line, "back_to_line");
  FollowPathConfig follow_path = add_section(follow_path, "follow_path");
  SearchConfig search = add_section(search, "search_object");
  TrackConfig track = add_section(track, "track_object");
  RotateConfig rotate = add_section(rotate, "rotate");
  ExploreConfig explore = add_section(explore, "explore");
  PregraspConfig pregrasp = add_section(pregrasp, "pregrasp");
  GraspConfig grasp = add_section(grasp, "grasp");
  DropConfig drop = add_section(drop, "drop");

  /// Takes over what the mission states to be known beforehand.
  void know(const PriorKnowledge& known) {
    object.object_radius_m = known.object_radius_m.value_or(object.object_radius_m);
    object.zone_radius_m = known.zone_radius_m.value_or(object.zone_radius_m);
  }
};

}  // namespace constrictor
