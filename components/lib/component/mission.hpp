// The mission that a scenario states. The launcher passes this section of the scenario, and nothing else of it, to the
// components (Setup::mission).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "configuration/configuration.hpp"
#include "constrictor/constants.hpp"

namespace constrictor {

/// Accepted radii of a zone: of scenes, of prior knowledge, and of what components take for one.
inline constexpr Range kZoneRadiusBounds_m{0.02, 5.0};
/// Accepted usual radii of an object: of prior knowledge, and of the parameters that take it over.
inline constexpr Range kObjectRadiusBounds_m{0.01, 2.0};
// What components assume of objects and zones if neither the mission nor an image shows it; defaults of parameters.
inline constexpr double kUsualObjectRadius_m = 0.085;
inline constexpr double kLargestObjectRadius_m = 0.2;  ///< of the objects that the robot is made for
inline constexpr double kUsualZoneRadius_m = 0.3;

/// The facts about the scene that are known before the mission begins. A quantity that is not given keeps the value
/// that each component's configuration has for it.
struct PriorKnowledge {
  std::optional<double> object_height_m;
  std::optional<double> object_radius_m;
  std::optional<double> object_max_radius_m;  ///< no object is larger
  std::optional<double> zone_radius_m;
  std::optional<double> line_width_m;
  std::optional<std::uint8_t> zones_at;  ///< kZones…
};

/// Where zones may lie.
inline constexpr std::uint8_t kZonesAtBeginning = 0;  ///< where the mission begins, at an end of the line
inline constexpr std::uint8_t kZonesAnywhere = 1;     ///< anywhere along the line
/// The names of these values in configuration.
[[nodiscard]] inline std::vector<std::string> zones_at_names() { return {"beginning", "anywhere"}; }

/// The time limits of the mission [s], all in simulated or robot time. A limit that is not given keeps the value of
/// the planner's configuration. sim/scenario_loader/README.md says what happens when each of them passes.
struct TimeLimits {
  std::optional<double> mission_s;  ///< whole mission
  std::optional<double> search_s;   ///< a search for the line
  std::optional<double> follow_s;   ///< following the line in one direction
  std::optional<double> find_s;     ///< a search for an object
  std::optional<double> task_s;     ///< track, pregrasp, grasp and drop, each
  std::optional<double> drop_s;     ///< nearing the zone with the object
};

struct Mission {
  std::vector<std::uint8_t> sequence;           ///< colours of the objects (msg::kColour…) in the order of retrieval
  std::uint8_t line_colour = msg::kColourBlue;  ///< of the line that the robot follows
  PriorKnowledge known;
  TimeLimits limits;
};

/// Reads `{sequence: [green, red], line_colour: blue, known: {zone_radius_m: 0.25}, time_limits: {mission_s: 600}}`;
/// `known` and `time_limits` may be left out. Throws ConfigurationError, also if the line has the colour of an object.
[[nodiscard]] Mission read_mission(Configuration root);

/// The same from the text of Setup::mission; nothing if the text is empty.
[[nodiscard]] std::optional<Mission> parse_mission(const std::string& text);

/// The section `known` of the mission in a text; all quantities are unset if the text is empty.
[[nodiscard]] PriorKnowledge prior_knowledge(const std::string& text);

}  // namespace constrictor
