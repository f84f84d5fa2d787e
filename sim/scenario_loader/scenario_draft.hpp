// A scenario file before the seed has chosen its variation.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "configuration/configuration.hpp"
#include "sim/scenario_loader/random_scene.hpp"
#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// A position relative to the world or to an end of the line.
struct Placement {
  std::string frame;                     ///< "world", "line_begin" or "line_end"
  Eigen::Vector2d position_m{0.0, 0.0};  ///< in the frame
  double yaw_rad = 0.0;
};

/// Ranges of the variation about the values of the file. Fields whose name has no unit are relative: 0.1 is 10 %.
struct Variation {
  bool mirror_line = false, object_sides = false, zone_sides = false;
  double line_curvature = 0.0, line_length = 0.0;
  double object_position_m = 0.0, zone_position_m = 0.0;
  double start_position_m = 0.0, start_yaw_rad = 0.0;
  double radius = 0.0, height = 0.0, mass = 0.0, friction = 0.0;
  double light_intensity = 0.0, light_direction_rad = 0.0;
  double camera_noise = 0.0;
};

/// A scenario file as it was read, before a seed is applied. `fixed` holds the values that do not depend on the frames
/// of the line.
struct ScenarioDraft {
  Scenario fixed;
  std::vector<Placement> objects;
  std::vector<Placement> zones;
  std::vector<Placement> obstacles;
  Placement start;
  Variation variation;
  std::optional<RandomScene> random;  ///< the seed draws the whole scene; the placements and the variation are empty
  Mission mission;                    ///< of the file, if it has one
};

/// Reads and checks the keys of a scenario file. Throws ConfigurationError.
[[nodiscard]] ScenarioDraft read_scenario_draft(Configuration root);

}  // namespace constrictor
