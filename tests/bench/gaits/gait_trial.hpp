// Drives the simulated robot with one of control's methods, on ground and between walls of one's choice.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "control/control_method.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::gaits {

struct Trial {
  std::string method;          ///< of control
  double frequency_hz = 0.5;   ///< negative: backwards
  double curvature_1_m = 0.0;  ///< of the path
  /// Coulomb coefficient of the skin on the ground in each direction; empty: along and across as in the robot's file.
  std::optional<double> friction;
  double channel_m = 0.0;  ///< width of a straight channel along the body; 0: open ground
  double duration_s = 16.0;
  ControlConfig config{};
};

/// The body from above at one moment: the centres of the modules from the head, in the world's frame, which is that of
/// the straight body at the start.
struct Outline {
  double time_s = 0.0;
  std::vector<Eigen::Vector2d> modules_m;
};

struct Course {
  /// Mean velocity of the body's centre over the whole periods after the first `kSettle_s`, along the body's direction
  /// at their beginning and to the left of it.
  double forward_m_s = 0.0;
  double left_m_s = 0.0;
  double turn_rad_s = 0.0;         ///< mean rate of the body's direction, from tail to head
  double transport = 0.0;          ///< cost of transport: positive work of the joints for weight times way
  double largest_torque_nm = 0.0;  ///< of any joint after `kSettle_s`
  std::vector<Outline> outlines;   ///< one at the start, then one after each half of the time
};

/// [s] until the waves have their amplitude and the body follows them.
inline constexpr double kSettle_s = 4.0;

/// Throws std::invalid_argument if control has no such method, or if the method does not accept the trial.
[[nodiscard]] Course run(const RobotModel& robot, const Trial& trial);

/// [m/s] velocity to the left at which nothing slides when the body moves by sidewinding: material at the places that
/// touch the ground is at rest. The heading of the body along its length is H cos(2 pi s / lambda); the waves move
/// along the body at c = f lambda, and the body rests on the ground where its heading is largest, so that it moves
/// sideways at c sin H. The joint amplitude A is that of links of length d: A = 2 H sin(pi d / lambda). Derived from
/// the geometry of the serpenoid curve.
[[nodiscard]] double sidewinding_without_slip_m_s(const RobotModel& robot, const ControlConfig& config,
                                                  double frequency_hz);

}  // namespace constrictor::gaits
