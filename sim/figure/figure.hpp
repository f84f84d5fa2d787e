// The figure of a run, after the paper's Fig. 4: for each key moment the scene, the raw image, the processed image and
// the joint torques.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/figure/canvas.hpp"
#include "sim/figure/panels.hpp"

namespace constrictor::figure {

struct Heading {
  std::string title;
  std::string subtitle;
  std::string failure;  ///< why the mission did not succeed; empty if it succeeded
};

struct Row {
  double time_s = 0.0;
  std::string caption;      ///< what happened
  std::string state;        ///< state of the planner
  std::uint8_t colour = 0;  ///< msg::kColour… of the object or line
  Picture scene, camera, processed;
};

inline constexpr double kWidth = 1400.0;  ///< of the figure, in units of the drawing

/// Draws the figure. Each torque plot shows `window_s`. `scale`: pixels (PNG, SVG) or points (PDF) for each of the
/// kWidth units. Returns the bytes of the file.
[[nodiscard]] std::string draw_figure(const Heading& heading, const std::vector<Row>& rows, const TorqueSeries& torques,
                                      double window_s, Format format, double scale = 1.0);

}  // namespace constrictor::figure
