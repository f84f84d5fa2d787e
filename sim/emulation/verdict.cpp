#include "sim/emulation/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "configuration/configuration.hpp"
#include "constrictor/constants.hpp"
#include "sim/scenario_loader/line_end.hpp"

namespace constrictor::emulation {
namespace {

using nlohmann::ordered_json;

struct Place {
  bool in_zone = false;
  double distance_m = std::numeric_limits<double>::quiet_NaN();  ///< NaN: no zone has the colour
};

Place place_of(const World& world, std::size_t object) {
  Place place;
  const Eigen::Vector3d p = world.object_pose(object).translation();
  for (const ScenarioZone& zone : world.scenario().zones) {
    if (zone.colour != world.scenario().objects[object].colour) continue;
    const double distance_m = (p.head<2>() - zone.position_m).norm();
    if (!(distance_m >= place.distance_m)) place = {distance_m <= zone.radius_m, distance_m};
  }
  return place;
}

std::string shortfall(const World& world, const std::vector<std::uint8_t>& sequence) {
  const Scenario& scenario = world.scenario();
  if (sequence.empty()) return line_shortfall(world.module_pose(0).translation().head<2>(), scenario.line_m);
  std::vector<std::string> faults;
  for (std::uint8_t colour = 1; colour < msg::kColourCount; ++colour) {
    const auto wanted = std::count(sequence.begin(), sequence.end(), colour);
    if (wanted == 0) continue;
    std::ptrdiff_t found = 0;
    for (std::size_t i = 0; i < world.object_count(); ++i)
      found += scenario.objects[i].colour == colour && place_of(world, i).in_zone ? 1 : 0;
    if (found < wanted)
      faults.push_back(fmt::format("{}: found {} objects in their zone, accepted {}",
                                   name_of(constants::kColour, colour), found, wanted));
  }
  return fmt::format("{}", fmt::join(faults, "; "));
}

}  // namespace

std::vector<std::uint8_t> mission_sequence(const std::filesystem::path& scenario_file) {
  Configuration root = Configuration::load(scenario_file);
  if (!root.has("mission")) return {};
  std::vector<std::uint8_t> colours;
  for (const auto& name : root.section("mission").texts("sequence", {}, std::vector<std::string>{})) {
    if (const auto colour = value_of(constants::kColour, name)) colours.push_back(*colour);
  }
  return colours;
}

std::string verdict_json(const World& world, const std::vector<std::uint8_t>& sequence, std::int64_t left_out_ns) {
  const std::string reason = shortfall(world, sequence);
  ordered_json json = {{"success", reason.empty()},
                       {"reason", reason},
                       {"time_s", world.time_s()},
                       {"left_out_s", static_cast<double>(left_out_ns) * 1e-9},
                       {"objects", ordered_json::array()}};
  for (std::size_t i = 0; i < world.object_count(); ++i) {
    const Place place = place_of(world, i);
    json["objects"].push_back({{"colour", name_of(constants::kColour, world.scenario().objects[i].colour)},
                               {"in_zone", place.in_zone},
                               {"zone_distance_m", place.distance_m}});
  }
  return json.dump(2) + "\n";
}

}  // namespace constrictor::emulation
