// The line: offset, heading, curvature, points, end and colour, and the attitude of the head.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "configuration/counted.hpp"

#include "conform/perception_conformance.hpp"

namespace constrictor::conform {
namespace {

SyntheticScene scene_with(const PaintedLine& line) {
  SyntheticScene scene;
  scene.line = line;
  return scene;
}

/// The correct percept of the line at the lookahead of this percept.
struct Truth {
  double offset_m = 0.0, heading_rad = 0.0;
};
Truth truth_of(const PaintedLine& line, const msg::LinePercept& percept) {
  const double length = line.length_at_x(percept.lookahead_m);
  return {line.at(length).y(), line.heading_at(length)};
}

bool sees(const msg::LinePercept* percept) { return percept != nullptr && percept->visible; }

}  // namespace

void PerceptionConformance::check_line() {
  PaintedLine line;
  const msg::LinePercept* percept = line_of(scene_with(line));
  const bool seen = sees(percept);
  report_.judge(
      "line", !seen,
      seen ? fmt::format("from {:.2f} to {:.2f} m ahead", percept->near_m, percept->far_m) : "no line is visible",
      "look for the colour of task/status.parameters.line_colour; images are RGB, red first");
  std::string sign, offset = seen ? "" : "no line is visible", heading = offset;
  double largest_m = 0.0, largest_rad = 0.0;
  for (const double side : {1.0, -1.0}) {
    line = {};
    line.begin_y_m = 0.12 * side;
    percept = line_of(scene_with(line));
    if (!sees(percept)) {
      offset = "no line is visible beside the robot's path";
      continue;
    }
    const Truth truth = truth_of(line, *percept);
    largest_m = std::max(largest_m, std::abs(percept->offset_m - truth.offset_m));
    const std::string found = fmt::format("{:.3f} m, for a line at {:.3f} m", percept->offset_m, truth.offset_m);
    if (std::abs(percept->offset_m + truth.offset_m) < profile_.line_m) sign = found;
    else if (!(std::abs(percept->offset_m - truth.offset_m) < profile_.line_m)) offset = found;
  }
  report_.pass_unless("line_sign", sign, "positive is left", "y of G points to the left; or the image is mirrored");
  report_.pass_unless("line_offset", offset, fmt::format("{:.3f} m wrong at most", largest_m),
                      "project the pixels onto the ground with X_HC, the attitude and the height of the head");
  for (const double turn : {0.3, -0.3}) {
    line = {};
    line.heading_rad = turn;
    line.begin_y_m = -0.3 * turn;
    percept = line_of(scene_with(line));
    if (!sees(percept)) {
      heading = "no line is visible";
      continue;
    }
    const double error_rad = std::abs(percept->heading_rad - truth_of(line, *percept).heading_rad);
    largest_rad = std::max(largest_rad, error_rad);
    if (!(error_rad < profile_.heading_rad))
      heading = fmt::format("{:.2f} rad, for a line that leads to {:.2f} rad", percept->heading_rad, turn);
  }
  report_.pass_unless("line_heading", heading, fmt::format("{:.3f} rad wrong at most", largest_rad),
                      "the angle from x of G to the line at the lookahead, positive left, in radians");
}

void PerceptionConformance::check_line_shape() {
  std::string curvature, points;
  double largest_m = 0.0, first = 0.0;
  for (const double bend : {1.2, -1.2}) {
    PaintedLine line;
    line.begin_x_m = 0.0;
    line.curvature_1_m = bend;
    line.length_m = 1.2;
    const msg::LinePercept* percept = line_of(scene_with(line));
    if (!sees(percept)) {
      curvature = points = "no line is visible";
      continue;
    }
    const double ratio = percept->curvature_1_m / bend;
    if (first == 0.0) first = percept->curvature_1_m;
    if (!(std::abs(ratio - 1.0) < profile_.curvature_share))
      curvature = fmt::format("{:.2f} 1/m, for a line of {:.2f} 1/m", percept->curvature_1_m, bend);
    double last_m = -1e9;
    for (int i = 0; i < percept->point_count; ++i) {
      const Eigen::Vector2d point(percept->x_m[i], percept->y_m[i]);
      if (point.norm() < last_m) points = fmt::format("point {} is nearer than the one before", i);
      last_m = point.norm() - profile_.line_m;
      if (point.norm() > 0.8) continue;
      const double off_m = line.distance_m(point);
      largest_m = std::max(largest_m, off_m);
      if (off_m > profile_.line_m && points.empty())
        points = fmt::format("point {} at ({:.2f}, {:.2f}) m is not on the line", i, point.x(), point.y());
    }
    if (percept->point_count < 3) points = counted(percept->point_count, "point");
  }
  report_.pass_unless("line_curvature", curvature, fmt::format("{:.2f} 1/m, for a line of 1.20 1/m", first),
                      "one by the radius of the line, positive where it bends left");
  report_.pass_unless("line_points", points, fmt::format("{:.3f} m off at most", largest_m),
                      "write the middle of the line in G: x ahead of the head's centre, y to the left, near to far");
}

void PerceptionConformance::check_line_end() {
  constexpr double kEnd_m = 0.7;
  const auto end_with = [&](double pitch_rad, double roll_rad) -> const msg::LinePercept* {
    PaintedLine line;
    line.length_m = kEnd_m - line.begin_x_m;
    SyntheticScene scene = scene_with(line);
    scene.pitch_rad = pitch_rad;
    scene.roll_rad = roll_rad;
    return line_of(scene);
  };
  const msg::LinePercept* percept = end_with(0.0, 0.0);
  const bool ends = percept != nullptr && percept->end_visible;
  const double end_m = ends ? percept->end_distance_m : 0.0;
  const msg::LinePercept* endless = line_of(scene_with({}));
  const bool invents = endless != nullptr && endless->end_visible && endless->end_distance_m < 2.0;
  report_.judge("line_end", !(std::abs(end_m - kEnd_m) < profile_.end_m) || invents,
                !ends     ? std::string("no end is seen")
                : invents ? fmt::format("an end at {:.2f} m of a line of 5 m", endless->end_distance_m)
                          : fmt::format("{:.2f} m, for an end at {:.2f} m", end_m, kEnd_m),
                "set end_visible and end_distance_m when the line ends within the image, ahead");
  // A nod by 0.06 rad moves the horizon by a twentieth of the image, and the end by more than the tolerance.
  std::string wrong;
  double largest_m = 0.0;
  for (const double pitch_rad : {0.06, -0.06}) {
    percept = end_with(pitch_rad, 0.0);
    if (!sees(percept) || !percept->end_visible) {
      wrong = fmt::format("no end is seen with a pitch of {:.2f} rad", pitch_rad);
      continue;
    }
    largest_m = std::max(largest_m, std::abs(percept->end_distance_m - kEnd_m));
    if (!(std::abs(percept->end_distance_m - kEnd_m) < profile_.end_m))
      wrong = fmt::format("{:.2f} m, for an end at {:.2f} m, with a pitch of {:.2f} rad", percept->end_distance_m,
                          kEnd_m, pitch_rad);
  }
  percept = end_with(0.0, 0.15);
  if (sees(percept) && std::abs(percept->offset_m) > profile_.line_m)
    wrong = fmt::format("offset {:.3f} m of a line straight ahead, with a roll of 0.15 rad", percept->offset_m);
  report_.pass_unless("attitude", wrong, fmt::format("{:.3f} m wrong at most", largest_m),
                      "keep the attitudes of the last ticks, and take that of CameraImage.exposure_tick");
}

void PerceptionConformance::check_line_colour() {
  PaintedLine line;
  hand_.line_colour = msg::kColourRed;
  hand_.wait(5);
  const msg::LinePercept* percept = line_of(scene_with(line));
  std::string wrong;
  if (sees(percept)) wrong = "a blue line is visible while the task follows a red one";
  line.colour = msg::kColourRed;
  percept = line_of(scene_with(line));
  if (wrong.empty() && !sees(percept)) wrong = "the red line is not visible while the task follows it";
  if (wrong.empty() && percept->colour != msg::kColourRed)
    wrong = fmt::format("colour {} is named, while the task follows colour {}", percept->colour, msg::kColourRed);
  hand_.line_colour = msg::kColourBlue;
  hand_.wait(5);
  report_.pass_unless("line_colour", wrong, "that of the task", "read task/status.parameters.line_colour");
}

}  // namespace constrictor::conform
