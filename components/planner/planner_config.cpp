#include "planner/planner_config.hpp"

#include <string>

#include "configuration/configuration.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {
namespace {

const std::vector<std::string> kColours = {"green", "red", "blue", "yellow"};  // kColourGreen is 1

std::uint8_t colour_number(const std::string& name) {
  for (std::size_t i = 0; i < kColours.size(); ++i) {
    if (kColours[i] == name) return static_cast<std::uint8_t>(i + 1);
  }
  return msg::kColourUnknown;
}

}  // namespace

PlannerConfig load_planner_config(const std::filesystem::path& file) {
  Configuration yaml = Configuration::load(file);
  PlannerConfig config;
  for (const auto& colour : yaml.texts("sequence", kColours)) config.sequence.push_back(colour_number(colour));
  config.line_colour = colour_number(yaml.text("line_colour", kColours));
  if (config.sequence.empty() || config.sequence.size() > 16) {
    throw yaml.error("sequence", "found " + std::to_string(config.sequence.size()) + " colours, accepted 1 to 16");
  }
  for (const auto colour : config.sequence) {
    if (colour == config.line_colour) throw yaml.error("sequence", "found the line's colour, accepted others");
  }
  config.confirm_images = static_cast<int>(yaml.integer("confirm_images", 1, 100));
  config.object_range_m = yaml.number("object_range_m", {0.2, 20});
  config.zone_range_m = yaml.number("zone_range_m", {0.2, 20});
  config.on_zone_m = yaml.number("on_zone_m", {0, 5});
  config.remembered_range_m = yaml.number("remembered_range_m", {0.3, 100});
  config.aligned_rad = yaml.number("aligned_rad", {0.05, 1.5});
  config.straight_rad = yaml.number("straight_rad", {0.05, 1.5});
  config.explore_s = yaml.number("explore_s", {1, 600});
  config.rotate_s = yaml.number("rotate_s", {1, 600});
  config.after_end_s = yaml.number("after_end_s", {0, 600});
  config.turn_round_s = yaml.number("turn_round_s", {1, 600});
  config.search_timeout_s = yaml.number("search_timeout_s", {1, 3600});
  config.task_timeout_s = yaml.number("task_timeout_s", {1, 3600});
  config.follow_timeout_s = yaml.number("follow_timeout_s", {1, 3600});
  config.mission_timeout_s = yaml.number("mission_timeout_s", {1, 86400});
  config.holding_factor = yaml.number("holding_factor", {1, 20});
  config.max_recoveries = static_cast<int>(yaml.integer("max_recoveries", 0, 10000));
  yaml.finish();
  return config;
}

}  // namespace constrictor
