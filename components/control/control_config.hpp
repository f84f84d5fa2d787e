// The parameters of control: one row each. control.yaml and the table in README.md follow from the rows.
#pragma once

#include <fmt/format.h>

#include <cstdint>

#include "configuration/parameter_set.hpp"
#include "control/yaw_chain.hpp"

namespace constrictor {

/// The methods that move the body along a path, by the values of `motion.KIND.method`: DRIVE_METHODS in CMakeLists.txt.
const std::vector<std::string>& drive_methods();

/// How control performs a kind of motion along a path.
struct MotionParameters {
  std::uint8_t method = 0;  ///< index in drive_methods(); wrap and squeeze have methods of their own
  double amplitude_rad = 0.0;
  double wavelength_m = 1.0;
  double advance_m = 1.0;
};

/// Parameters of the method "sliding_mode"; methods/sliding_mode.cpp explains the law.
struct SlidingParameters {
  double surface_1_s = 0.0;
  double reaching_rad_s2 = 0.0;
  double layer_rad_s = 0.0;
  double estimate_s = 0.0;
  double mass_share = 0.0;
  std::uint8_t inertia = 0;
};
inline const std::vector<std::string>& sliding_inertias() {
  static const std::vector<std::string> names{"whole_body", "each_joint"};
  return names;
}

/// Parameters of the method "obstacle_aided"; methods/obstacle_aided.cpp explains the law.
struct ObstacleParameters {
  double swing_rad = 0.0;
  double path_m = 0.0;
  double bend_nm = 0.0;
  double avoid_rad = 0.0;
  double engaged_n = 0.0;
  double alone_s = 0.0;
  double search_s = 0.0;
};

struct ControlConfig : ParameterSet {
  using ParameterSet::add;
  /// The rows of a kind of motion whose method can be chosen.
  MotionParameters add(MotionParameters& motion, const std::string& kind, const MotionParameters& fallback,
                       const std::string& meaning) {
    const std::uint8_t method = add(motion.method, "motion." + kind + ".method", 0, drive_methods(), kWhileRunning,
                                    meaning + ": method, or undulation if it cannot do it");
    MotionParameters motion_parameters = add_gait(motion, kind, fallback, meaning);
    motion_parameters.method = method;
    return motion_parameters;
  }
  /// The rows of the gait of a kind of motion.
  MotionParameters add_gait(MotionParameters& motion, const std::string& kind, const MotionParameters& fallback,
                            const std::string& meaning) {
    const std::string key = "motion." + kind;
    return {0,
            add(motion.amplitude_rad, key + ".amplitude_rad", fallback.amplitude_rad, "rad", {0.0, 1.2}, kWhileRunning,
                meaning + ": amplitude of the wave's heading"),
            add(motion.wavelength_m, key + ".wavelength_m", fallback.wavelength_m, "m", {0.2, 5.0}, kWhileRunning,
                meaning + ": length of the wave along the body"),
            add(motion.advance_m, key + ".advance_m", fallback.advance_m, "m", {0.01, 5.0}, kWhileRunning,
                meaning + ": way of the body in one undulation")};
  }

  MotionParameters travel = add(travel, "travel", {0, 0.5, 1.07, 0.9}, "Moving without an object");
  MotionParameters carry =
      add(carry, "carry", {0, 1.0, 1.2, 0.24}, "Moving along a line or path with an object in the U");
  MotionParameters creep = add(creep, "creep", {0, 0.35, 1.07, 0.7}, "Small steps beside an object");
  MotionParameters wrap = add_gait(wrap, "wrap", {0, 0.45, 1.07, 0.4}, "Wrapping");
  MotionParameters seat = add(seat, "seat", {0, 0.8, 1.2, 0.15}, "Driving the base of the U to the object");
  MotionParameters squeeze = add_gait(squeeze, "squeeze", {0, 0.3, 1.07, 0.14}, "Squeezing");
  MotionParameters deliver =
      add(deliver, "deliver", {0, 0.8, 1.2, 0.17}, "Turns and nearing a zone with an object in the U");
  MotionParameters leave = add(leave, "leave", {0, 0.5, 0.9, 0.27}, "Backing off with an open U");
  double lookahead_m = add(lookahead_m, "path.lookahead_m", 0.5, "m", {0.05, 2.0}, kWhileRunning,
                           "The body steers towards the point of the path this far ahead of the head");
  double most_curvature_1_m =
      add(most_curvature_1_m, "path.most_curvature_1_m", 1.2, "1/m", {0.05, 5.0}, kWhileRunning,
          "Largest curvature towards a path of several pieces; a single arc is followed as it is");
  double carry_curvature_1_m =
      add(carry_curvature_1_m, "path.carry_curvature_1_m", 1.0, "1/m", {0.05, 5.0}, kWhileRunning,
          "The same as most_curvature_1_m for a body in a posture, such as a U with an object");
  double most_hz = add(most_hz, "wave.most_hz", 1.2, "Hz", {0.05, 2.0}, kWhileRunning,
                       "Most undulations per second: a faster motion stays slower than desired");
  WaveWeights weights{
      add(weights.head, "wave.head_weights", {0.0, 0.5, 0.8}, "", {0.0, 1.0}, {0, 16},
          "Share of the wave's amplitude in the first links (1 in all others); 0 keeps the head on the mean heading"),
      add(weights.rigid_bend_rad, "wave.rigid_bend_rad", 1.047, "rad", {0.1, 3.2}, kAtStart,
          "A link between two joints of the posture that are bent by this angle does not undulate")};
  double amplitude_rate_rad_s = add(amplitude_rate_rad_s, "wave.amplitude_rate_rad_s", 1.0, "rad/s", {0.01, 10.0},
                                    kWhileRunning, "Maximum rate of change of the wave's amplitude");
  double frequency_rate_hz_s = add(frequency_rate_hz_s, "wave.frequency_rate_hz_s", 1.0, "Hz/s", {0.01, 10.0},
                                   kWhileRunning, "Maximum rate of change of the wave's frequency");
  double wavelength_rate_m_s = add(wavelength_rate_m_s, "wave.wavelength_rate_m_s", 0.5, "m/s", {0.01, 10.0},
                                   kWhileRunning, "Maximum rate of change of the wavelength");
  double curvature_rate_1_ms = add(curvature_rate_1_ms, "wave.curvature_rate_1_ms", 1.5, "1/(m s)", {0.01, 20.0},
                                   kWhileRunning, "Maximum rate of change of the path's curvature");
  double shape_rate_rad_s = add(shape_rate_rad_s, "posture.shape_rate_rad_s", 0.5, "rad/s", {0.01, 4.0}, kWhileRunning,
                                "Speed of each joint towards a new posture, unless the trajectory names a speed");
  double blend_rate_rad_s = add(blend_rate_rad_s, "posture.blend_rate_rad_s", 0.5, "rad/s", {0.01, 4.0}, kWhileRunning,
                                "Speed at which each joint leaves an earlier posture");
  double lift_rad = add(lift_rad, "posture.lift_rad", 0.005, "rad", {0.0, 0.2}, kWhileRunning,
                        "Angle by which the base of a U is raised while the body moves");
  double sidewinding_yaw_rad = add(sidewinding_yaw_rad, "sidewinding.yaw_rad", 0.5, "rad", {0.05, 1.2}, kWhileRunning,
                                   "Amplitude of the yaw joints when the robot moves by sidewinding");
  double sidewinding_pitch_rad =
      add(sidewinding_pitch_rad, "sidewinding.pitch_rad", 0.15, "rad", {0.0, 0.8}, kWhileRunning,
          "Amplitude of the pitch joints when the robot moves by sidewinding");
  double sidewinding_wavelength_m = add(sidewinding_wavelength_m, "sidewinding.wavelength_m", 1.07, "m", {0.3, 5.0},
                                        kWhileRunning, "Wavelength of sidewinding along the body");
  double rolling_rad = add(rolling_rad, "rolling.amplitude_rad", 0.15, "rad", {0.02, 0.4}, kWhileRunning,
                           "Amplitude of all joints when the robot rolls: the arc that its body forms");
  double pitch_wave_rad = add(pitch_wave_rad, "pitch_wave.amplitude_rad", 0.4, "rad", {0.02, 1.0}, kWhileRunning,
                              "Amplitude of the pitch joints when the robot moves by a vertical wave");
  double pitch_wave_wavelength_m = add(pitch_wave_wavelength_m, "pitch_wave.wavelength_m", 0.8, "m", {0.3, 5.0},
                                       kWhileRunning, "Wavelength of the vertical wave along the body");
  double concertina_rad = add(concertina_rad, "concertina.amplitude_rad", 0.9, "rad", {0.05, 1.4}, kWhileRunning,
                              "Amplitude of the yaw joints when the body folds between two walls");
  double concertina_wavelength_m = add(concertina_wavelength_m, "concertina.wavelength_m", 1.07, "m", {0.3, 5.0},
                                       kWhileRunning, "Wavelength of the folds along the body");
  SlidingParameters sliding{
      add(sliding.surface_1_s, "sliding_mode.surface_1_s", 14.0, "1/s", {0.1, 100.0}, kWhileRunning,
          "Slope of the sliding surface: rate at which an error of the angle fades on it"),
      add(sliding.reaching_rad_s2, "sliding_mode.reaching_rad_s2", 60.0, "rad/s2", {0.1, 1000.0}, kWhileRunning,
          "Acceleration towards the sliding surface, outside of the boundary layer"),
      add(sliding.layer_rad_s, "sliding_mode.layer_rad_s", 5.0, "rad/s", {0.01, 100.0}, kWhileRunning,
          "Half width of the boundary layer; at least as wide as the tick allows"),
      add(sliding.estimate_s, "sliding_mode.estimate_s", 0.05, "s", {0.0, 10.0}, kWhileRunning,
          "Time constant of the estimate of unknown torques"),
      add(sliding.mass_share, "sliding_mode.mass_share", 1.0, "", {0.0, 2.0}, kWhileRunning,
          "Share of the modules' mass that the law counts with: a body lighter than this share swings"),
      add(sliding.inertia, "sliding_mode.inertia", 0, sliding_inertias(), kWhileRunning,
          "Inertia that the law knows: of the whole body, or of each joint by itself")};
  ObstacleParameters obstacles{
      add(obstacles.swing_rad, "obstacle_aided.swing_rad", 1.4, "rad", {0.1, 1.5}, kWhileRunning,
          "Amplitude of the head's heading when the robot moves among obstacles"),
      add(obstacles.path_m, "obstacle_aided.path_m", 2.0, "m", {0.3, 10.0}, kWhileRunning,
          "The head swings once more for each such length by which the shape has moved along the body"),
      add(obstacles.bend_nm, "obstacle_aided.bend_nm", 10.0, "Nm", {0.1, 100.0}, kWhileRunning,
          "Torque of a joint when the angles in front of it and behind it differ by 1 rad"),
      add(obstacles.avoid_rad, "obstacle_aided.avoid_rad", 0.8, "rad", {0.0, 1.5}, kWhileRunning,
          "Angle by which the head turns away from an obstacle that stops it"),
      add(obstacles.engaged_n, "obstacle_aided.engaged_n", 5.0, "N", {0.0, 1000.0}, kWhileRunning,
          "Forward force of all obstacles together below which the robot counts as not supported by them"),
      add(obstacles.alone_s, "obstacle_aided.alone_s", 3.0, "s", {0.1, 1000.0}, kWhileRunning,
          "Time without support after which the robot moves sideways to find other obstacles"),
      add(obstacles.search_s, "obstacle_aided.search_s", 2.0, "s", {0.1, 100.0}, kWhileRunning,
          "Time for which the robot moves sideways in a search")};
  double base_bend_rad = add(base_bend_rad, "squeeze.base_bend_rad", 0.5, "rad", {0.1, 1.5}, kAtStart,
                             "Joints of the posture that are bent by more than this are the base of a U");
  double squeeze_rate_rad_s = add(squeeze_rate_rad_s, "squeeze.rate_rad_s", 0.2, "rad/s", {0.001, 2.0}, kWhileRunning,
                                  "Speed of the squeeze, summed over the joints of the base");
  double opening_share = add(opening_share, "squeeze.opening_share", 0.5, "", {0.0, 1.0}, kWhileRunning,
                             "Share of the squeeze by which the two joints beside the base open, in total");
  double speed_share = add(speed_share, "safety.speed_share", 0.8, "", {0.01, 1.0}, kAtStart,
                           "Share of the servos' maximum speed that control uses");
  double lead_s = add(lead_s, "safety.lead_s", 0.06, "s", {0.02, 1.0}, kAtStart,
                      "A setpoint leads a joint that cannot follow by the angle of its torque limit, plus at most the "
                      "way at full speed in this time");
  std::int64_t hold_after_ticks =
      add(hold_after_ticks, "safety.hold_after_ticks", 10, "ticks", {2, 1000}, kAtStart,
          "Control holds the posture when the newest desired trajectory is older than this");
  std::int64_t relax_after_ticks = add(
      relax_after_ticks, "safety.relax_after_ticks", 250, "ticks", {2, 100000}, kAtStart,
      "Control relaxes the joints when the newest desired trajectory is older than this; at least hold_after_ticks");

  /// Checks conditions on several parameters together. Throws ConfigurationError.
  void complete(const Configuration& root) const {
    if (relax_after_ticks >= hold_after_ticks) return;
    throw root.error("safety.relax_after_ticks", fmt::format("found {}, accepted at least safety.hold_after_ticks ({})",
                                                             relax_after_ticks, hold_after_ticks));
  }
};

}  // namespace constrictor
