// Parameters of perception, read from perception.yaml.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "constrictor/messages.hpp"

namespace constrictor::perception {

/// Hues of one colour; from > to passes through 0.
struct HueRange {
  double from_deg = 0.0;
  double to_deg = 0.0;
};

struct PerceptionConfig {
  std::uint8_t line_colour = msg::kColourBlue;
  double line_width_m = 0.05;
  double lookahead_m = 0.35;
  double line_max_range_m = 2.0;
  double line_max_gap_m = 0.35;
  double object_height_m = 0.15;
  int min_area_pixels = 14;
  double blob_max_range_m = 6.0;
  double min_chroma = 0.075;
  double min_saturation = 0.33;
  std::array<HueRange, msg::kColourCount> hues{{{}, {85, 165}, {340, 18}, {195, 262}, {42, 72}}};
};

/// Names of the colours by their number ("unknown", "green", "red", "blue", "yellow").
inline constexpr std::array<std::string_view, msg::kColourCount> kColourNames{"unknown", "green", "red", "blue", "yellow"};

/// Throws ConfigurationError.
PerceptionConfig load_perception_config(const std::filesystem::path& file);

}  // namespace constrictor::perception
