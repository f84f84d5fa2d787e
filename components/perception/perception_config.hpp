// The parameters of perception: one row each. perception.yaml and the table in README.md follow from the rows.
#pragma once

#include <array>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "component/mission.hpp"
#include "configuration/parameter_set.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/messages.hpp"
#include "perception/percept_errors.hpp"
#include "robot/ground_slope_config.hpp"

namespace constrictor::perception {

/// Hues of one colour. If `from_deg` is greater than `to_deg`, the range passes through 0.
struct HueRange {
  double from_deg = 0.0;
  double to_deg = 0.0;
};

/// The hues of each colour under the shipped configuration [deg]: one row for each constant kColour… of the IDL, in
/// their order.
inline constexpr HueRange kShippedHues[] = {
    {},              // unknown
    {85.0, 165.0},   // green
    {340.0, 18.0},   // red
    {195.0, 262.0},  // blue
    {42.0, 72.0},    // yellow
};
static_assert(std::size(kShippedHues) == msg::kColourCount, "each colour of the IDL needs a row in kShippedHues");

struct PerceptionConfig : ParameterSet {
  std::uint8_t line_colour = add(line_colour, "line.colour", msg::kColourBlue, colour_names(),
                                 "Colour of the line until a task names another");
  double line_width_m = add(line_width_m, "line.width_m", 0.05, "m", {0.01, 0.3}, kWhileRunning,
                            "Expected width of the line; half to twice of it is accepted");
  double lookahead_m =
      add(lookahead_m, "line.lookahead_m", 0.35, "m", {0.1, 2.0}, kWhileRunning,
          "Distance at which offset, heading and curvature of the line are given, if it is seen there");
  double line_max_range_m = add(line_max_range_m, "line.max_range_m", 2.0, "m", {0.2, 10.0}, kWhileRunning,
                                "The line is not traced beyond this distance");
  double line_max_gap_m = add(line_max_gap_m, "line.max_gap_m", 0.35, "m", {0.0, 2.0}, kWhileRunning,
                              "Longest hidden stretch of the line that is bridged");
  double object_height_m = add(object_height_m, "object.height_m", 0.15, "m", {0.02, 2.0}, kWhileRunning,
                               "Height of an object whose height no image has shown yet");
  double object_radius_m = add(object_radius_m, "object.radius_m", 0.0, "m", {0.0, 2.0}, kWhileRunning,
                               "Radius of an object whose size no image has shown yet; 0: unknown");
  double object_max_radius_m = add(object_max_radius_m, "object.max_radius_m", kLargestObjectRadius_m, "m", {0.02, 2.0},
                                   kWhileRunning, "No object is larger: what is wider and below the horizon is a zone");
  int min_area_pixels = add(min_area_pixels, "blob.min_area_pixels", 14, "pixels", {1, 10000}, kWhileRunning,
                            "Smaller blobs are ignored");
  double blob_max_range_m = add(blob_max_range_m, "blob.max_range_m", 6.0, "m", {0.2, 50.0}, kWhileRunning,
                                "More distant objects and zones are not reported");
  double obstacle_max_range_m = add(obstacle_max_range_m, "obstacle.max_range_m", 1.2, "m", {0.0, 5.0}, kWhileRunning,
                                    "More distant obstacles are not reported; 0: none is looked for");
  double obstacle_min_contrast = add(obstacle_min_contrast, "obstacle.min_contrast", 0.06, "", {0.01, 1.0},
                                     kWhileRunning, "Least difference to ground and background (full scale: 1)");
  GroundSlopeConfig ground = add_section(ground, "ground");
  int frozen_after = add(frozen_after, "camera.frozen_after", 3, "images", {0, 1000}, kWhileRunning,
                         "After this many equal images, further ones are refused: the camera is frozen. 0: never");
  int picture_period = add(picture_period, "picture_period", 5, "images", {1, 1000}, kWhileRunning,
                           "Every n-th image of a camera is drawn, and the first after an event; 1: every image");
  double min_chroma = add(min_chroma, "colour.min_chroma", 0.075, "", {0.01, 0.5}, kWhileRunning,
                          "Least difference between the channels of a coloured pixel (full scale: 1)");
  double min_saturation = add(min_saturation, "colour.min_saturation", 0.33, "", {0.05, 0.95}, kWhileRunning,
                              "Least ratio of that difference to the largest channel of a coloured pixel");
  std::array<HueRange, msg::kColourCount> hues = add_hues();
  PerceptErrorConfig errors = add_section(errors, "error");
  bool height_stated = false;  ///< the mission states the height of the objects

  /// Takes over what the mission states to be known beforehand.
  void know(const PriorKnowledge& known) {
    object_height_m = known.object_height_m.value_or(object_height_m);
    height_stated = known.object_height_m.has_value();
    object_radius_m = known.object_radius_m.value_or(object_radius_m);
    object_max_radius_m = known.object_max_radius_m.value_or(object_max_radius_m);
    line_width_m = known.line_width_m.value_or(line_width_m);
  }

 private:
  /// The names by number; "unknown" has no name here, because no file may contain it.
  static std::vector<std::string> colour_names() {
    std::vector<std::string> names = names_of(constants::kColour, msg::kColourGreen);
    names.insert(names.begin(), "");
    return names;
  }
  std::array<HueRange, msg::kColourCount> add_hues() {
    std::array<HueRange, msg::kColourCount> shipped{};
    for (std::uint8_t colour = msg::kColourUnknown + 1; colour < msg::kColourCount; ++colour) {
      const std::string name = name_of(constants::kColour, colour);
      const std::string key = "colour." + name;
      const auto [from_deg, to_deg] = kShippedHues[colour];
      shipped[colour] = {add(hues[colour].from_deg, key + ".from_deg", from_deg, "deg", {0.0, 360.0}, kWhileRunning,
                             "First hue of " + name + " (0 red, 120 green, 240 blue)"),
                         add(hues[colour].to_deg, key + ".to_deg", to_deg, "deg", {0.0, 360.0}, kWhileRunning,
                             "Last hue of " + name + "; the range passes through 0 if it is less than the first")};
    }
    return shipped;
  }
};

}  // namespace constrictor::perception
