// The figure of a run, drawn by a module that is loaded when the first figure is drawn: Cairo, Pango and their 20
// libraries would make the start of every process that contains the report slower.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/figure/figure.hpp"

namespace constrictor::figure {

/// A row whose pictures are PNG files. A missing file leaves an empty frame.
struct FileRow {
  double time_s = 0.0;
  std::string caption, state;
  std::uint8_t colour = 0;  ///< msg::kColour…
  std::filesystem::path scene, camera, processed;
};

/// draw_figure() of figure.hpp as a PNG file. Throws std::runtime_error, also if the module is missing.
[[nodiscard]] std::string draw_png_lazily(const Heading& heading, const std::vector<FileRow>& rows,
                                          const std::string& torques_csv, double window_s);

}  // namespace constrictor::figure
