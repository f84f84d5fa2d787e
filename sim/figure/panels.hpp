// The parts of which the figure of a run and the frames of its film are made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "sim/figure/canvas.hpp"

namespace constrictor::figure {

/// Torques of the yaw joints over time.
struct TorqueSeries {
  std::vector<double> time_s;
  std::vector<std::vector<double>> torque_nm;  ///< a series for each joint, head to tail, as long as time_s
};

/// Reads joint_torques.csv: a heading, then a line "time,torque,torque,…" for each sample.
[[nodiscard]] TorqueSeries parse_torques(const std::string& csv);

/// [Nm] limit of the plots: the 99.8th percentile of all torques, rounded up, 2 to 10 Nm.
[[nodiscard]] double torque_limit(const TorqueSeries& torques);

struct TorqueAxes {
  double from_s = 0.0, to_s = 1.0;  ///< the time that is shown
  double limit_nm = 6.0;
  double moment_s = 0.0;                                           ///< marked by a line
  double drawn_until_s = std::numeric_limits<double>::infinity();  ///< later torques are left out
};

/// A plot with its axes in `area`, which contains their numbers. `font`: size of the numbers.
void draw_torques(Canvas& canvas, const Rect& area, const TorqueSeries& torques, const TorqueAxes& axes, double font);

/// Shows which colour belongs to which joint, with its right end at `right` and the baseline of its text at y. It never
/// begins before `left`: the colours of many joints are narrower. Draws nothing where there is no room for colours.
void draw_joint_key(Canvas& canvas, std::size_t joints, double left, double right, double y, double font);

/// A picture in a frame; if it is empty, a grey area with the words `missing`.
void draw_picture(Canvas& canvas, const Rect& area, const Picture& picture, const std::string& missing);

/// The colour of an object or line (msg::kColour…), chosen so that colour-blind readers can distinguish them.
[[nodiscard]] Colour display_colour(std::uint8_t colour);

[[nodiscard]] std::string number(double value, int decimals);

}  // namespace constrictor::figure
