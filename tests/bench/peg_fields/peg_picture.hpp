// Draws runs through fields of pegs from above.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/peg_fields/peg_trial.hpp"

namespace constrictor::peg_fields {

struct Panel {
  std::string title;
  Scenario scene;
  Course course;
};

/// Writes a PNG file with one panel below the other. The body is drawn at the start and after each ten seconds, from
/// pale to dark; a square marks the head.
void draw(const std::filesystem::path& file, const std::vector<Panel>& panels, double body_radius_m);

}  // namespace constrictor::peg_fields
