// Parameters of navigation and its tasks, read from navigation.yaml. Lengths in m, angles in rad, times in s.
#pragma once

#include <cstdint>
#include <filesystem>

#include "navigation/line_watch.hpp"
#include "navigation/object_watch.hpp"
#include "navigation/pid.hpp"

namespace constrictor {

struct Gait {
  double frequency_hz = 0.7;
  double amplitude_rad = 0.5;
  double wavelength_m = 1.07;
};

/// The U that holds an object, and how it is held.
struct GripConfig {
  int base_first_joint = 5;         ///< first yaw joint of the base
  int base_joints = 3;              ///< number of yaw joints of the base
  double base_angle_rad = 1.047;    ///< of each base joint in the open U
  double opening_share = 0.5;       ///< of the closing, by which the joints beside the base open (as control's squeeze does)
  double hold_margin_rad = 0.03;    ///< by which the held base joints are asked to close further
  double hold_torque_nm = 1.5;      ///< cap of the base joints while carrying
  // loss of the grasp, watched from the grasp to the drop
  double lost_torque_nm = 0.5;      ///< mean closing torque of the base joints below which the grasp may be lost
  double lost_contact_share = 0.25; ///< share of time in which the base feels a touch, below which it may be lost
  double lost_filter_s = 1.0;       ///< low-pass of both
  double lost_after_s = 2.0;        ///< time below both after which it is lost
  double touch_force_n = 0.4;       ///< weakest touch that counts
};

struct FollowLineConfig {
  PidGains steering{6.0, 1.0, 0.0, 1.2, 0.2};  ///< cross-track error [m] to curvature [1/m]
  double carry_limit_1_m = 1.0;                ///< curvature limit while carrying
  double end_reached_m = 0.35;                 ///< distance to the line's end at which it is reached
  int end_images = 3;                          ///< images in a row that must show the end
};

struct FollowPathConfig {
  PidGains steering{8.0, 2.0, 0.0, 1.2, 0.2};  ///< lateral offset of the path at the lookahead [m] to curvature [1/m]
  double lookahead_m = 0.35;
  double reached_m = 0.1;          ///< the path ends so far before its last point
  double lost_m = 1.0;             ///< distance from the path beyond which it is given up
};

struct SearchConfig {
  double head_turn_rad = 0.9;      ///< how far the head looks to each side, over its three joints
  double head_rate_rad_s = 0.25;   ///< of each of the three joints
  double near_m = 0.7;                ///< a remembered object nearer to the body than this is left before the body turns
  double remembered_m = 3.0;          ///< a remembered object farther off is not looked for where it was
  double advance_m = 0.5;          ///< between looks
  double turn_rad = 1.6;           ///< turn on the spot after every second look
  double turn_curvature_1_m = 2.3;
  double confirm_s = 1.0;          ///< for which the object must stay in view
};

struct TrackConfig {
  PidGains steering{2.5, 0.2, 0.0, 1.3, 0.2};  ///< bearing [rad] to curvature [1/m]
  double reach_m = 0.9;            ///< distance from the head to the object's surface at which it is reached
  double reach_bearing_rad = 0.3;
  double straight_rad = 0.5;       ///< within which the body must point to the object, too
  double too_near_m = 0.45;        ///< nearer than this, or near and not in front of a straight body: go away
  double away_m = 1.3;             ///< so far, measured from the head
  double turn_rad = 1.0;           ///< an object farther round than this is turned to on the spot
  double turn_curvature_1_m = 2.3;
  double memory_s = 20.0;          ///< for which it is steered towards an object that is out of the field of view
  double half_view_rad = 0.7;      ///< an object within this bearing should be seen
};

struct RotateConfig {
  double curvature_1_m = 2.3;
  double carry_curvature_1_m = 1.0;
};

struct ExploreConfig {
  double head_turn_rad = 0.9;
  double head_rate_rad_s = 0.25;
  double step_m = 0.5;
  double carry_turn_rad = 0.3;
};

struct PregraspConfig {
  double seen_within_s = 3.0;         ///< the object must have been seen this recently
  double clearance_m = 0.05;          ///< between body and object while passing it
  PidGains steering{5.0, 0.0, 0.0, 1.3, 0.2};  ///< distance to the passing line [m] to curvature [1/m]
  double lookahead_m = 0.3;
  double past_m = 0.2;                ///< how far the head passes the object's centre before it feels for it
  double brake_m = 0.12;              ///< run-out after the wave stops
  double settle_s = 1.5;
  double touch_rate_rad_s = 0.12;     ///< of each of the three joints near the head
  double touch_limit_rad = 0.3;       ///< of each of them
  double touch_further_rad = 0.1;     ///< more, after each attempt that felt nothing
  double touch_force_n = 0.4;
  double deep_min_m = -0.4;           ///< accepted place of the object's centre along the body, from the head (behind is negative)
  double deep_max_m = -0.12;
  int attempts = 4;
  double other_clearance_m = 0.3;     ///< wanted between the manoeuvre's path and other objects
};

struct GraspConfig {
  double wrap_speed_m_s = 0.15;       ///< of the arc at first; then as fast as the body moves
  double wrap_still_m = 0.3;          ///< slid by the arc before the body begins to move
  double wrap_speed_min_m_s = 0.08;
  double wrap_speed_max_m_s = 0.35;
  double wrap_speed_filter_s = 1.0;
  Gait wrap{0.4, 0.35, 1.07};
  Gait seat{0.7, 0.4, 1.07};
  Gait squeeze{0.7, 0.3, 1.07};
  double touch_memory_s = 3.0;        ///< for which a touch counts, as the gait makes touches intermittent
  double seat_force_n = 1.0;
  double seat_time_s = 1.0;           ///< of touch in the middle of the base
  double seat_timeout_s = 20.0;
  double squeeze_max_rad = 0.9;
  double squeeze_torque_nm = 3.0;     ///< closing torque of a base joint at which it is squeezed enough
  double squeeze_cap_nm = 6.0;        ///< torque cap of the base joints while squeezing
  int squeeze_attempts = 3;           ///< each after driving on further
  int touching_modules = 2;           ///< that must touch the object
  double check_s = 3.0;               ///< for which the hold is checked
};

struct DropConfig {
  PidGains steering{5.0, 0.0, 0.0, 1.0, 0.2};  ///< distance to the course [m] to curvature [1/m]
  double fix_course_m = 0.35;         ///< distance of the object from the zone's centre at which the course is fixed
  double brake_m = 0.08;              ///< run-out of the object after the wave stops
  double lookahead_m = 0.5;
  double open_angle_rad = 0.873;      ///< of each base joint when it lets go
  double open_s = 4.0;
  double back_m = 1.3;
  double back_timeout_s = 20.0;
  double straighten_rate_rad_s = 0.3;
  double approach_timeout_s = 120.0;  ///< [s] without reaching the zone's centre; the task then ends without success, still holding
};

struct NavigationConfig {
  Gait travel{0.7, 0.5, 1.07};
  Gait carry{1.1, 0.6, 1.07};
  Gait creep{0.4, 0.35, 1.07};
  std::int64_t stale_after_ticks = 25;  ///< age of joints or pose at which navigation holds
  LineWatchLimits line;
  ObjectWatchLimits object;
  GripConfig grip;
  FollowLineConfig follow_line;
  FollowPathConfig follow_path;
  SearchConfig search;
  TrackConfig track;
  RotateConfig rotate;
  ExploreConfig explore;
  PregraspConfig pregrasp;
  GraspConfig grasp;
  DropConfig drop;
};

/// Throws ConfigurationError.
NavigationConfig load_navigation_config(const std::filesystem::path& file);

}  // namespace constrictor
