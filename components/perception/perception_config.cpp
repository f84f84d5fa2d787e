#include "perception/perception_config.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "configuration/configuration.hpp"

namespace constrictor::perception {

PerceptionConfig load_perception_config(const std::filesystem::path& file) {
  PerceptionConfig config;
  Configuration root = Configuration::load(file);

  Configuration line = root.section("line", false);
  const std::vector<std::string> colours(kColourNames.begin() + 1, kColourNames.end());
  const std::string colour = line.text("colour", colours, std::string(kColourNames[config.line_colour]));
  const auto found = std::find(kColourNames.begin(), kColourNames.end(), colour);
  config.line_colour = static_cast<std::uint8_t>(found - kColourNames.begin());
  config.line_width_m = line.number("width_m", {0.01, 0.3}, config.line_width_m);
  config.lookahead_m = line.number("lookahead_m", {0.1, 2.0}, config.lookahead_m);
  config.line_max_range_m = line.number("max_range_m", {0.2, 10.0}, config.line_max_range_m);
  config.line_max_gap_m = line.number("max_gap_m", {0.0, 2.0}, config.line_max_gap_m);
  line.finish();

  Configuration object = root.section("object", false);
  config.object_height_m = object.number("height_m", {0.02, 2.0}, config.object_height_m);
  object.finish();

  Configuration blob = root.section("blob", false);
  config.min_area_pixels = static_cast<int>(blob.integer("min_area_pixels", 1, 10000, config.min_area_pixels));
  config.blob_max_range_m = blob.number("max_range_m", {0.2, 50.0}, config.blob_max_range_m);
  blob.finish();

  Configuration colour_section = root.section("colour", false);
  config.min_chroma = colour_section.number("min_chroma", {0.01, 0.5}, config.min_chroma);
  config.min_saturation = colour_section.number("min_saturation", {0.05, 0.95}, config.min_saturation);
  for (std::size_t i = 1; i < kColourNames.size(); ++i) {
    Configuration range = colour_section.section(kColourNames[i], false);
    config.hues[i].from_deg = range.number("from_deg", {0.0, 360.0}, config.hues[i].from_deg);
    config.hues[i].to_deg = range.number("to_deg", {0.0, 360.0}, config.hues[i].to_deg);
    range.finish();
  }
  colour_section.finish();
  root.finish();
  return config;
}

}  // namespace constrictor::perception
