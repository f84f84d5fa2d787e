// Turns the path and the velocity of a desired trajectory into the gait by which control performs its motion.
#pragma once

#include <string_view>

#include "control/control_config.hpp"

namespace constrictor {

/// An undulation, and the curvature of the path along which it moves the body.
struct Gait {
  double frequency_hz = 0.0;   ///< undulations per second; negative: backwards
  double amplitude_rad = 0.0;  ///< of the links' heading
  double wavelength_m = 1.0;   ///< along the body
  double curvature_1_m = 0.0;  ///< of the path, positive to the left
  double lift_rad = 0.0;       ///< by which the base of a U is raised
};

/// Name of the control method for a kind of motion: the configured one if there is a choice. A kind that control does
/// not know is the name of a method itself.
[[nodiscard]] std::string_view method_of(std::string_view motion, const ControlConfig& config);

/// Whether this kind of motion moves the body along a path by a method that can be chosen.
[[nodiscard]] bool drives(std::string_view motion);

/// The gait of a motion. The frequency is the desired speed divided by the distance that the body advances in an
/// undulation of this kind of motion, at most wave.most_hz. A body that keeps a limit of its lateral acceleration
/// undulates less, and then more slowly. The path must be valid (robot/trajectory_path.hpp).
[[nodiscard]] Gait gait_of(const msg::DesiredTrajectory& desired, const ControlConfig& config);

/// [m/s2] largest lateral acceleration of a body that undulates: it moves sideways by amplitude x wavelength / 2 pi.
[[nodiscard]] double lateral_acceleration_m_s2(const Gait& gait);

}  // namespace constrictor
