// The parameters of guidance: one row each. guidance.yaml and the table in README.md follow from the rows.
#pragma once

#include "component/mission.hpp"
#include "configuration/parameter_set.hpp"
#include "guidance/odometry.hpp"
#include "robot/ground_slope_config.hpp"

namespace constrictor::guidance {

/// When a landmark that is not seen any more is given up.
struct ExistenceConfig : ParameterSet {
  double detection_probability = add(detection_probability, "detection_probability", 0.9, "", {0.01, 0.999},
                                     kWhileRunning, "Probability that a look shows a landmark that is clearly in view");
  double false_alarm_probability = add(false_alarm_probability, "false_alarm_probability", 0.1, "", {0.001, 0.99},
                                       kWhileRunning, "Probability that a look shows a landmark that does not exist");
  double look_s = add(look_s, "look_s", 0.5, "s", {0.02, 10.0}, kWhileRunning,
                      "Time between independent looks: the images within it have common errors");
  double most = add(most, "most", 0.99, "", {0.5, 0.999999}, kAtStart,
                    "Highest probability that a landmark exists, however often it was seen");
  double trust = add(trust, "trust", 0.5, "", {0.01, 0.99}, kWhileRunning,
                     "A landmark whose probability is lower does not correct the pose");
  double drop = add(drop, "drop", 0.05, "", {0.0, 0.99}, kWhileRunning,
                    "A landmark whose probability is lower leaves the map; 0: none does");
  double min_range_m = add(min_range_m, "min_range_m", 0.3, "m", {0.0, 20.0}, kWhileRunning,
                           "A landmark that is nearer to the camera need not be in view");
  double max_range_m = add(max_range_m, "max_range_m", 1.6, "m", {0.0, 20.0}, kWhileRunning,
                           "A landmark that is farther from the camera need not be in view");
  double margin_rad = add(margin_rad, "margin_rad", 0.12, "rad", {0.0, 1.0}, kWhileRunning,
                          "Least angle between a landmark and the border of the image, or what may hide it");

  void complete(const Configuration& root) const {
    if (false_alarm_probability < detection_probability) return;
    throw root.error("false_alarm_probability", "found at least detection_probability, accepted less");
  }
};

struct GuidanceConfig : ParameterSet {
  OdometryConfig odometry{
      add(odometry.slip_scale_m_s, "odometry.slip_scale_m_s", 0.005, "m/s", {1e-4, 1.0}, kWhileRunning,
          "Sliding speed from which the skin's friction is fully developed"),
      add(odometry.joint_gain, "odometry.joint_gain", 0.25, "", {0.01, 1.0}, kWhileRunning,
          "Share of a joint's measured angle; the rest is its integrated rate"),
      add(odometry.friction_along, "odometry.friction_along", 0.1, "", {0.0, 5.0}, kAtStart,
          "First guess of the coefficient of friction along the body, until it has been measured"),
      add(odometry.friction_across, "odometry.friction_across", 0.7, "", {0.01, 5.0}, kAtStart,
          "First guess of the coefficient of friction across the body, until it has been measured"),
      add(odometry.friction_rate_1_s, "odometry.friction_rate_1_s", 0.6, "1/s", {0.0, 100.0}, kWhileRunning,
          "Speed at which the estimated coefficients follow the measured forces of the ground"),
      add(odometry.stick_below, "odometry.stick_below", 0.8, "", {0.0, 1.0}, kWhileRunning,
          "A module sticks if its sideways force is below this share of its friction"),
      add(odometry.stick_factor, "odometry.stick_factor", 4.0, "", {1.0, 1000.0}, kWhileRunning,
          "Factor on the resistance of such a module against sliding sideways")};
  double speed_sd = add(speed_sd, "odometry.speed_sd", 0.08, "", {0.0, 1.0}, kWhileRunning,
                        "Standard deviation of the estimated velocity, as a share of the speed");
  double speed_sd_m_s = add(speed_sd_m_s, "odometry.speed_sd_m_s", 0.01, "m/s", {0.0, 1.0}, kAtStart,
                            "Standard deviation of the estimated velocity, added at any speed");
  double pushing_speed_sd = add(pushing_speed_sd, "odometry.pushing_speed_sd", 0.4, "", {0.0, 10.0}, kWhileRunning,
                                "speed_sd of a robot without a skin beside an object that it may push");
  double lifting_rad_s = add(lifting_rad_s, "odometry.lifting_rad_s", 0.05, "rad/s", {0.0, 10.0}, kWhileRunning,
                             "Mean rate of the pitch joints above which modules leave the ground");
  double lifting_speed_sd_m_s =
      add(lifting_speed_sd_m_s, "odometry.lifting_speed_sd_m_s", 0.3, "m/s", {0.0, 10.0}, kWhileRunning,
          "Standard deviation of the estimated velocity while modules leave the ground");
  double lifting_correlation_s =
      add(lifting_correlation_s, "odometry.lifting_correlation_s", 10.0, "s", {0.01, 1000.0}, kWhileRunning,
          "Time over which the error of the velocity stays the same while modules leave the ground");
  double correlation_s = add(correlation_s, "odometry.correlation_s", 0.7, "s", {0.01, 10.0}, kAtStart,
                             "Time over which the error of the estimated velocity stays the same");
  double scale_sd = add(scale_sd, "odometry.scale_sd", 0.03, "", {0.0, 1.0}, kWhileRunning,
                        "Standard deviation of the factor between the true and the estimated drift");
  double unmeasured_scale_sd = add(unmeasured_scale_sd, "odometry.unmeasured_scale_sd", 0.25, "", {0.0, 1.0},
                                   kWhileRunning, "scale_sd without measured forces of the ground");
  double scale_s = add(scale_s, "odometry.scale_s", 30.0, "s", {0.1, 1e4}, kWhileRunning,
                       "Time over which this factor stays the same");
  double yaw_sd_rad_sqrt_s = add(yaw_sd_rad_sqrt_s, "odometry.yaw_sd_rad_sqrt_s", 0.003, "rad/sqrt(s)", {0.0, 1.0},
                                 kWhileRunning, "Growth of the yaw's standard deviation");
  double unmeasured_yaw_sd_rad_sqrt_s =
      add(unmeasured_yaw_sd_rad_sqrt_s, "odometry.unmeasured_yaw_sd_rad_sqrt_s", 0.05, "rad/sqrt(s)", {0.0, 1.0},
          kWhileRunning, "The same without samples of the inertial unit: the turns follow from the joints");
  double speed_window_s = add(speed_window_s, "odometry.speed_window_s", 1.5, "s", {0.1, 2.0}, kWhileRunning,
                              "Time over which the published speed is averaged; about a gait period");

  GroundSlopeConfig ground = add_section(ground, "ground");

  double bearing_sd_rad = add(bearing_sd_rad, "landmarks.bearing_sd_rad", 0.02, "rad", {1e-3, 1.0}, kWhileRunning,
                              "Standard deviation of a percept's bearing");
  double range_sd_m = add(range_sd_m, "landmarks.range_sd_m", 0.015, "m", {1e-3, 1.0}, kWhileRunning,
                          "Standard deviation of a percept's range close to the head");
  double range_sd_1_m = add(range_sd_1_m, "landmarks.range_sd_1_m", 0.04, "1/m", {0.0, 1.0}, kAtStart,
                            "Factor of the squared range in that standard deviation: distant pixels cover more ground");
  double inflation = add(inflation, "landmarks.inflation", 4.0, "", {1.0, 1000.0}, kAtStart,
                         "Factor on the variance of percepts, because successive percepts have common errors");
  double max_range_m = add(max_range_m, "landmarks.max_range_m", 2.5, "m", {0.1, 20.0}, kWhileRunning,
                           "More distant percepts are ignored");
  double gate = add(gate, "landmarks.gate", 11.8, "", {1.0, 100.0}, kWhileRunning,
                    "Squared Mahalanobis distance up to which a percept belongs to a landmark");
  double merge_m = add(merge_m, "landmarks.merge_m", 0.5, "m", {0.0, 5.0}, kWhileRunning,
                       "A percept outside of the gate but nearer than this shows a landmark that has moved");
  double object_radius_m =
      add(object_radius_m, "landmarks.object_radius_m", kUsualObjectRadius_m, "m", kObjectRadiusBounds_m, kAtStart,
          "Radius of an object until an image shows its whole width");
  double zone_radius_m = add(zone_radius_m, "landmarks.zone_radius_m", kUsualZoneRadius_m, "m", kZoneRadiusBounds_m,
                             kAtStart, "Radius of a zone until an image shows its whole width");
  int confirm = add(confirm, "landmarks.confirm", 3, "", {1, 100}, kWhileRunning,
                    "Number of percepts until a new landmark, or its new place, is believed");

  ExistenceConfig existence = add_section(existence, "existence");

  double line_spacing_m = add(line_spacing_m, "line.spacing_m", 0.05, "m", {0.01, 1.0}, kAtStart,
                              "Distance between the line's points in the map");
  double line_map_range_m = add(line_map_range_m, "line.map_range_m", 0.9, "m", {0.1, 5.0}, kWhileRunning,
                                "More distant points of the line are not mapped");
  double line_correct_after_s =
      add(line_correct_after_s, "line.correct_after_s", 10.0, "s", {0.0, 1000.0}, kWhileRunning,
          "Points of the line that have been in the map for longer than this correct the pose");
  double line_correct_sd_m = add(line_correct_sd_m, "line.correct_sd_m", 0.03, "m", {1e-3, 1.0}, kAtStart,
                                 "Standard deviation of such a correction at the head");
  double line_correct_gate_m = add(line_correct_gate_m, "line.correct_gate_m", 0.2, "m", {0.01, 1.0}, kAtStart,
                                   "Greatest distance between the line in view and in the map");

  int obstacle_confirm = add(obstacle_confirm, "obstacles.confirm", 5, "", {1, 1000}, kWhileRunning,
                             "Number of images that show an obstacle until it is believed");
  int obstacle_misses = add(obstacle_misses, "obstacles.misses", 15, "", {1, 1000}, kWhileRunning,
                            "After so many images that should show it and do not, it is forgotten");

  double touch_min_force_n =
      add(touch_min_force_n, "touch.min_force_n", 0.4, "N", {0.0, 100.0}, kWhileRunning, "Weaker touches are ignored");
  double touch_max_normal_z = add(touch_max_normal_z, "touch.max_normal_z", 0.5, "", {0.0, 1.0}, kAtStart,
                                  "Contacts whose unit normal has a greater vertical part belong to the ground");
  double touch_self_margin_m = add(touch_self_margin_m, "touch.self_margin_m", 0.012, "m", {0.0, 0.1}, kAtStart,
                                   "Contacts this near to the skin of another module are the robot's own");
  double touch_keep_s = add(touch_keep_s, "touch.keep_s", 4.0, "s", {0.1, 100.0}, kWhileRunning,
                            "Time for which a touch stays in the map");

  /// Takes over what the mission states to be known beforehand.
  void know(const PriorKnowledge& known) {
    object_radius_m = known.object_radius_m.value_or(object_radius_m);
    zone_radius_m = known.zone_radius_m.value_or(zone_radius_m);
  }
};

}  // namespace constrictor::guidance
