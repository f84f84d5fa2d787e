// Experiments that several checks need: a robot over the edge of a table or of a wall, and its swinging head. The
// robots, scenes and gaits of the unit tests are included.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <vector>

#include "sim/world/world.hpp"
#include "unit/world/world_fixture.hpp"

namespace constrictor::validation {

/// A scene in which the first `overhang` joints of a straight robot are in the air and the rest of it lies on a box.
/// Pitch joints: the box is a table, and the robot lies on it. Yaw joints: gravity points to the right, and the robot
/// lies with its right side on a wall, high above the ground. The robot starts at rest.
[[nodiscard]] Scenario beyond_an_edge(const RobotModel& robot, JointAxis axis, std::size_t overhang);

/// The robot of this name (components/lib/robot/NAME.yaml).
[[nodiscard]] inline RobotModel robot_file(const std::string& name) { return load_robot(testing::robot_path(name)); }

/// [kg m²] of the rotor that the head turns with it when it swings: about its own inertia about the joint.
inline constexpr double kSwingingRotor_kg_m2 = 0.001;

/// A head that swings.
struct Swing {
  std::vector<double> time_s;
  std::vector<double> angle_rad;  ///< from the vertical
  std::vector<double> energy_j;   ///< of the head and its rotor, kinetic and potential

  /// Mean time between two passages through the vertical in the same direction; NaN if there are fewer than two.
  [[nodiscard]] double period_s() const;
};

/// Lets the head swing freely from `amplitude_rad` on the relaxed joint behind it, beyond the edge of a table.
[[nodiscard]] Swing swing_head(double amplitude_rad, double duration_s, const SolverSettings& settings);

}  // namespace constrictor::validation
