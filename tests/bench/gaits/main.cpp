// Measures control's gaits in the simulated world and draws them: a table, gaits.json and gaits.png.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/gaits/gait_trial.hpp"
#include "bench/measure_main.hpp"
#include "sim/figure/canvas.hpp"

namespace constrictor::gaits {
namespace {

using figure::Align;
using figure::Canvas;
using figure::Colour;
using figure::Point;
using figure::Rect;

/// A gait, and a ground on which it is measured.
struct Row {
  std::string ground;
  Trial trial;
  bool drawn = true;
};

std::vector<Row> rows() {
  constexpr double kIsotropic = 0.4;
  std::vector<Row> rows;
  const auto add = [&](const std::string& method, double frequency_hz, std::optional<double> friction, double channel_m,
                       bool drawn) {
    Trial trial;
    trial.method = method;
    trial.frequency_hz = frequency_hz;
    trial.friction = friction;
    trial.channel_m = channel_m;
    rows.push_back({channel_m > 0.0 ? fmt::format("channel of {:g} m, friction {:g}", channel_m, kIsotropic)
                    : friction      ? fmt::format("friction {:g} in each direction", *friction)
                                    : "the robot's skin",
                    trial, drawn});
  };
  add("undulation", 0.5, std::nullopt, 0.0, true);
  add("undulation", 0.5, kIsotropic, 0.0, false);
  add("sidewinding", 0.5, kIsotropic, 0.0, true);
  add("sidewinding", 0.5, std::nullopt, 0.0, false);
  add("rolling", 0.5, kIsotropic, 0.0, true);
  add("rolling", 0.5, std::nullopt, 0.0, false);
  add("pitch_wave", 0.5, kIsotropic, 0.0, true);
  add("pitch_wave", 0.5, std::nullopt, 0.0, false);
  add("concertina", 0.5, kIsotropic, 0.3, true);
  add("concertina", 0.5, kIsotropic, 0.0, false);
  return rows;
}

std::string speed_text(const Course& course) {
  const double sideways = std::abs(course.left_m_s);
  const bool left = sideways > std::abs(course.forward_m_s);
  const double speed_m_s = left ? sideways : std::abs(course.forward_m_s);
  constexpr double kStands_m_s = 0.01;
  if (speed_m_s < kStands_m_s) return "stands";
  const char* where = left ? (course.left_m_s > 0.0 ? "to the left" : "to the right")
                           : (course.forward_m_s > 0.0 ? "forward" : "backward");
  return fmt::format("{:.2f} m/s {}", speed_m_s, where);
}

// The panels share one scale, so that the ways can be compared.
constexpr double kWidth = 980.0;
constexpr double kPixels_m = 100.0;  // units of the drawing for a metre
constexpr double kMargin = 14.0;
constexpr double kHeading = 46.0;
constexpr double kLeft_m = 2.5;  // of the panel's left edge behind the head's start

struct Extent {
  double low_m = -0.25, high_m = 0.25;
};

Extent extent_of(const Course& course) {
  Extent extent;
  for (const Outline& outline : course.outlines) {
    for (const auto& at : outline.modules_m) {
      extent.low_m = std::min(extent.low_m, at.y() - 0.1);
      extent.high_m = std::max(extent.high_m, at.y() + 0.1);
    }
  }
  return extent;
}

double panel_height(const Course& course) {
  const Extent extent = extent_of(course);
  return kHeading + (extent.high_m - extent.low_m) * kPixels_m + kMargin;
}

void draw_panel(Canvas& canvas, double top, const Row& row, const Course& course) {
  const Extent extent = extent_of(course);
  canvas.text(row.trial.method, {kMargin, top + 22.0}, {16.0, figure::kInk, true});
  canvas.text(fmt::format("{}, {:g} Hz: {}", row.ground, row.trial.frequency_hz, speed_text(course)),
              {kMargin + 130.0, top + 22.0}, {14.0, figure::kInk, false});
  const Rect area{kMargin, top + kHeading - 12.0, kWidth - 2.0 * kMargin, (extent.high_m - extent.low_m) * kPixels_m};
  canvas.frame(area, figure::kFaint, 1.0);
  const auto place = [&](const Eigen::Vector2d& at) {
    return Point{area.x + (at.x() + kLeft_m) * kPixels_m, area.y + (extent.high_m - at.y()) * kPixels_m};
  };
  if (row.trial.channel_m > 0.0) {
    for (const double side : {-1.0, 1.0}) {
      const double y = place({0.0, side * 0.5 * row.trial.channel_m}).y;
      canvas.line({area.x, y}, {area.x + area.width, y}, figure::kGreyInk, 3.0);
    }
  }
  // From the palest, at the start, to the darkest, at the end. Pale and dark differ for every reader.
  const Colour colours[] = {{0.74, 0.82, 0.90}, {0.42, 0.60, 0.78}, {0.06, 0.25, 0.47}};
  for (std::size_t i = 0; i < course.outlines.size(); ++i) {
    std::vector<Point> body;
    for (const auto& at : course.outlines[i].modules_m) body.push_back(place(at));
    canvas.polyline(body, area, colours[i], 6.0);
    canvas.fill({body.front().x - 5.0, body.front().y - 5.0, 10.0, 10.0}, colours[i]);
  }
}

void draw(const std::filesystem::path& file, const std::vector<Row>& rows, const std::vector<Course>& courses) {
  double height = 56.0;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].drawn) height += panel_height(courses[i]);
  Canvas canvas(figure::Format::kPng, kWidth, height, 1.0, "Gaits");
  canvas.fill({0.0, 0.0, kWidth, height}, figure::kWhite);
  canvas.text(fmt::format("The body from above after 0, {:.0f} and {:.0f} s (pale to dark); a square marks the head",
                          courses.front().outlines[1].time_s, courses.front().outlines[2].time_s),
              {kMargin, 26.0}, {14.0, figure::kGreyInk, false});
  const double right = kWidth - kMargin;
  canvas.line({right - kPixels_m, 20.0}, {right, 20.0}, figure::kInk, 2.0);
  canvas.text("1 m", {right - 0.5 * kPixels_m, 38.0}, {13.0, figure::kInk, false, Align::kCentre});
  double top = 48.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].drawn) continue;
    draw_panel(canvas, top, rows[i], courses[i]);
    top += panel_height(courses[i]);
  }
  std::ofstream(file, std::ios::binary) << canvas.finish();
}

void measure(const std::filesystem::path& robot_file, const std::filesystem::path& output) {
  const RobotModel robot = load_robot(robot_file);
  std::vector<Row> measured;
  std::vector<Course> courses;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  fmt::print("| gait | ground | frequency | speed | cost of transport | largest torque |\n|---|---|---|---|---|---|\n");
  for (const Row& row : rows()) {
    Course course;
    try {
      course = run(robot, row.trial);
    } catch (const std::invalid_argument&) {
      fmt::print("| `{}` | {} | | this robot cannot | | |\n", row.trial.method, row.ground);
      continue;
    }
    const bool moves = speed_text(course) != "stands";
    fmt::print("| `{}` | {} | {:g} Hz | {} | {} | {:.1f} Nm |\n", row.trial.method, row.ground, row.trial.frequency_hz,
               speed_text(course), moves ? fmt::format("{:.2f}", course.transport) : "", course.largest_torque_nm);
    std::cout.flush();
    json.push_back({{"method", row.trial.method},
                    {"ground", row.ground},
                    {"frequency_hz", row.trial.frequency_hz},
                    {"forward_m_s", course.forward_m_s},
                    {"left_m_s", course.left_m_s},
                    {"turn_rad_s", course.turn_rad_s},
                    {"cost_of_transport", course.transport},
                    {"largest_torque_nm", course.largest_torque_nm}});
    measured.push_back(row);
    courses.push_back(course);
  }
  if (courses.empty()) throw std::runtime_error("no gait suits the robot " + robot.name);
  std::ofstream(output / "gaits.json") << json.dump(2) << '\n';
  draw(output / "gaits.png", measured, courses);
  fmt::print("\ngaits: {} and {}\n", (output / "gaits.png").string(), (output / "gaits.json").string());
}

}  // namespace
}  // namespace constrictor::gaits

int main(int argc, char** argv) {
  return constrictor::bench::measure_main(argc, argv, "gaits",
                                          "measure control's gaits in the simulated world and draw them",
                                          "gaits.png and gaits.json", constrictor::gaits::measure);
}
