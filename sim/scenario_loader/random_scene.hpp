// Scenes that the seed draws as a whole: line, objects, zones and pegs, within the ranges of a scenario file.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "component/mission.hpp"
#include "configuration/configuration.hpp"
#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// The section `random` of a scenario file.
struct RandomScene {
  Range line_length_m{2.5, 4.0};
  Range bend_radius_m{1.0, 2.0};
  Range bend_rad{0.4, 1.2};  ///< change of heading in one bend
  Range object_radius_m{0.07, 0.1};
  Range object_height_m{0.12, 0.2};
  Range object_mass_kg{0.3, 0.6};
  double box_share = 0.0;  ///< probability that an object is a box
  Range zone_radius_m{0.35, 0.4};
  int pegs = 0;
  int strangers = 0;      ///< objects of colours that the mission does not name
  double friction = 0.1;  ///< relative
};

/// Reads the section. Throws ConfigurationError.
[[nodiscard]] RandomScene read_random_scene(Configuration from);

inline constexpr std::size_t kMostRandomZones = 2;  ///< one on each side of the start

/// A scene without overlapping bodies in which the mission is possible; empty if 200 draws have found none. `base`:
/// what does not depend on the draw. The objects stand beyond the end of the line, one behind the other; the zones lie
/// on both sides of the start, which is that of the case study; pegs and strangers keep off the robot's way. Equal
/// arguments give equal scenes.
[[nodiscard]] std::optional<Scenario> make_random_scene(const RandomScene& ranges, const Mission& mission,
                                                        const Scenario& base, std::uint64_t seed);

}  // namespace constrictor
