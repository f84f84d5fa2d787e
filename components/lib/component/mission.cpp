#include "component/mission.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace constrictor {
namespace {

PriorKnowledge read_knowledge(Configuration root) {
  PriorKnowledge known;
  const auto read = [&root](const char* key, Range accepted, std::optional<double>& value) {
    if (root.has(key)) value = root.number(key, accepted);
  };
  read("object_height_m", {0.02, 2.0}, known.object_height_m);
  read("object_radius_m", kObjectRadiusBounds_m, known.object_radius_m);
  read("object_max_radius_m", {0.02, 2.0}, known.object_max_radius_m);
  read("zone_radius_m", kZoneRadiusBounds_m, known.zone_radius_m);
  if (known.object_radius_m && known.object_max_radius_m && *known.object_radius_m > *known.object_max_radius_m) {
    throw root.error("object_radius_m",
                     fmt::format("found {:g}, more than object_max_radius_m: {:g}, accepted a usual radius of objects "
                                 "that is at most the largest; correct one of the two keys",
                                 *known.object_radius_m, *known.object_max_radius_m));
  }
  read("line_width_m", {0.01, 0.3}, known.line_width_m);
  if (root.has("zones_at")) {
    const std::vector<std::string> names = zones_at_names();
    const auto name = std::find(names.begin(), names.end(), root.text("zones_at", names));
    known.zones_at = static_cast<std::uint8_t>(name - names.begin());
  }
  root.finish();
  return known;
}

TimeLimits read_limits(Configuration root) {
  TimeLimits limits;
  const auto read = [&root](const char* key, double longest_s, std::optional<double>& value) {
    if (root.has(key)) value = root.number(key, {1.0, longest_s});
  };
  read("mission_s", 86400.0, limits.mission_s);
  read("search_s", 3600.0, limits.search_s);
  read("follow_s", 3600.0, limits.follow_s);
  read("find_s", 3600.0, limits.find_s);
  read("task_s", 3600.0, limits.task_s);
  read("drop_s", 3600.0, limits.drop_s);
  root.finish();
  return limits;
}

}  // namespace

Mission read_mission(Configuration root) {
  const std::vector<std::string> colours = names_of(constants::kColour, msg::kColourGreen);
  Mission mission;
  for (const std::string& colour : root.texts("sequence", colours))
    mission.sequence.push_back(*value_of(constants::kColour, colour));
  mission.line_colour = *value_of(constants::kColour, root.text("line_colour", colours));
  if (std::count(mission.sequence.begin(), mission.sequence.end(), mission.line_colour) > 0)
    throw root.error("line_colour", "found the colour of an object, accepted another colour");
  if (root.has("known")) mission.known = read_knowledge(root.section("known"));
  if (root.has("time_limits")) mission.limits = read_limits(root.section("time_limits"));
  root.finish();
  return mission;
}

std::optional<Mission> parse_mission(const std::string& text) {
  if (text.empty()) return std::nullopt;
  return read_mission(Configuration::parse(text, "--mission"));
}

PriorKnowledge prior_knowledge(const std::string& text) {
  const std::optional<Mission> mission = parse_mission(text);
  return mission ? mission->known : PriorKnowledge{};
}

}  // namespace constrictor
