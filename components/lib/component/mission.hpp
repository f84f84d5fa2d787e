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

/// The facts about the scene that are known before the mission begins. A quantity that is not given keeps the value
/// that each component's configuration has for it.
struct PriorKnowledge {
  std::optional<double> object_height_m;
  std::optional<double> object_radius_m;
  std::optional<double> object_max_radius_m;  ///< no object is larger
  std::optional<double> zone_radius_m;
  std::optional<double> line_width_m;
};

struct Mission {
  std::vector<std::uint8_t> sequence;           ///< colours of the objects (msg::kColour…) in the order of retrieval
  std::uint8_t line_colour = msg::kColourBlue;  ///< of the line that the robot follows
  PriorKnowledge known;
};

/// Reads `{sequence: [green, red], line_colour: blue, known: {zone_radius_m: 0.25}}`; `known` may be left out. Throws
/// ConfigurationError, also if the line has the colour of an object.
[[nodiscard]] Mission read_mission(Configuration root);

/// The same from the text of Setup::mission; nothing if the text is empty.
[[nodiscard]] std::optional<Mission> parse_mission(const std::string& text);

/// The section `known` of the mission in a text; all quantities are unset if the text is empty.
[[nodiscard]] PriorKnowledge prior_knowledge(const std::string& text);

}  // namespace constrictor
