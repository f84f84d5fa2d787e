#include "perception/perception_parameters.hpp"

#include <string>

namespace constrictor::perception {

void add_parameters(PerceptionConfig& c, Parameters& p) {
  p.add(c.line_width_m, "line.width_m", "m", {0.01, 0.3}, "about, of the line: half to twice of it is accepted");
  p.add(c.lookahead_m, "line.lookahead_m", "m", {0.1, 2.0}, "where the line's offset, heading and curvature are given");
  p.add(c.line_max_range_m, "line.max_range_m", "m", {0.2, 10.0}, "farther away the ground is seen too flat for the line");
  p.add(c.line_max_gap_m, "line.max_gap_m", "m", {0.0, 2.0}, "a hidden stretch of the line that is bridged");
  p.add(c.object_height_m, "object.height_m", "m", {0.02, 2.0}, "of objects, for the range when their lower edge is hidden");
  p.add(c.min_area_pixels, "blob.min_area_pixels", "", {1.0, 10000.0}, "smaller blobs are specks");
  p.add(c.blob_max_range_m, "blob.max_range_m", "m", {0.2, 50.0}, "farther objects and zones are not reported");
  p.add(c.min_chroma, "colour.min_chroma", "", {0.01, 0.5}, "largest minus smallest channel of what has a colour");
  p.add(c.min_saturation, "colour.min_saturation", "", {0.05, 0.95}, "chroma over largest channel of what has a colour");
  for (std::size_t i = 1; i < kColourNames.size(); ++i) {
    const std::string key = "colour." + std::string(kColourNames[i]);
    p.add(c.hues[i].from_deg, key + ".from_deg", "deg", {0.0, 360.0}, "first hue of " + std::string(kColourNames[i]));
    p.add(c.hues[i].to_deg, key + ".to_deg", "deg", {0.0, 360.0}, "last hue of " + std::string(kColourNames[i]) + ", through 0 if it is less than the first");
  }
}

}  // namespace constrictor::perception
